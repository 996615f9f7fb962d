/// bench_release FIRST RUNS [torque | velocity | quadbot] runs random sequences of deaths, restarts, resets and senders
/// on all cores (tests/loop/release_sequences.h). The last argument is robot.wheel_command, or the robot on legs.

#include <cstdlib>
#include <string_view>

#include "bench/programs/rows.h"
#include "bench/programs/seed_trials.h"
#include "loop/release_sequences.h"
#include "rt/clock.h"

namespace robot_control::bench {

void run(std::uint64_t first, std::uint64_t runs, std::string_view robot) {
  std::mutex adding;
  ReleaseFigures all;
  const std::int64_t start = monotonic_ns();
  const auto failed = static_cast<double>(
      SeedTrials(robot == "quadbot" ? "release --robot quadbot" : "release", [&](std::uint64_t seed) {
        ReleaseFigures figures;
        auto violated = robot == "quadbot"
                            ? walking_release_violation(seed, figures)
                            : release_violation(seed, figures,
                                                robot == "velocity" ? WheelCommand::kVelocity : WheelCommand::kTorque);
        const std::lock_guard lock(adding);
        all.moving_cycles += figures.moving_cycles;
        all.accepted_resets += figures.accepted_resets;
        all.starts += figures.starts;
        all.standing_cycles += figures.standing_cycles;
        all.lying_cycles += figures.lying_cycles;
        return violated;
      }).run(first, runs));
  const double seconds = 1e-9 * static_cast<double>(monotonic_ns() - start);
  const auto sequences = static_cast<double>(runs);
  print("release", {{"sequences", sequences, robot == "quadbot" ? "of 12000 cycles" : "of 2000 cycles", 0, "none", 0},
                    {"sequences failed", failed, "", 0, "none", 0},
                    {"starts of a node", static_cast<double>(all.starts), "", 0, "none", 0},
                    {"cycles in motion", static_cast<double>(all.moving_cycles), "", 0, "none", 0},
                    {"cycles on its feet", static_cast<double>(all.standing_cycles), "", 0, "none", 0},
                    {"cycles judged to lie", static_cast<double>(all.lying_cycles), "", 0, "none", 0},
                    {"accepted resets", static_cast<double>(all.accepted_resets), "", 0, "none", 0},
                    {"speed", sequences / seconds, "1/s", 0, "none", 0}});
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  const std::string_view robot = argc == 4 ? argv[3] : "torque";
  if (argc < 3 || argc > 4 || (robot != "torque" && robot != "velocity" && robot != "quadbot")) {
    std::cerr << "usage: bench_release FIRST RUNS [torque | velocity | quadbot]\n";
    return 2;
  }
  robot_control::bench::run(std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10), robot);
}
