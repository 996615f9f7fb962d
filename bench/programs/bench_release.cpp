/// bench_release FIRST RUNS [torque | velocity] runs random sequences of deaths, restarts, resets and senders on all
/// cores (tests/loop/release_sequences.h). The last argument is robot.wheel_command.

#include <cstdlib>
#include <string_view>

#include "bench/programs/rows.h"
#include "bench/programs/seed_trials.h"
#include "loop/release_sequences.h"
#include "rt/clock.h"

namespace robot_control::bench {
namespace {

void run(std::uint64_t first, std::uint64_t runs, WheelCommand drives) {
  std::mutex adding;
  ReleaseFigures all;
  const std::int64_t start = monotonic_ns();
  const auto failed = static_cast<double>(SeedTrials("release", [&](std::uint64_t seed) {
                                            ReleaseFigures figures;
                                            auto violated = release_violation(seed, figures, drives);
                                            const std::lock_guard lock(adding);
                                            all.moving_cycles += figures.moving_cycles;
                                            all.accepted_resets += figures.accepted_resets;
                                            all.starts += figures.starts;
                                            return violated;
                                          }).run(first, runs));
  const double seconds = 1e-9 * static_cast<double>(monotonic_ns() - start);
  const auto sequences = static_cast<double>(runs);
  print("release", {{"sequences", sequences, "of 2000 cycles", 0, "none", 0},
                    {"sequences failed", failed, "", 0, "none", 0},
                    {"starts of a node", static_cast<double>(all.starts), "", 0, "none", 0},
                    {"cycles in motion", static_cast<double>(all.moving_cycles), "", 0, "none", 0},
                    {"accepted resets", static_cast<double>(all.accepted_resets), "", 0, "none", 0},
                    {"speed", sequences / seconds, "1/s", 0, "none", 0}});
}

}  // namespace
}  // namespace robot_control::bench

int main(int argc, char** argv) {
  using robot_control::WheelCommand;
  const std::string_view drives = argc == 4 ? argv[3] : "torque";
  if (argc < 3 || argc > 4 || (drives != "torque" && drives != "velocity")) {
    std::cerr << "usage: bench_release FIRST RUNS [torque | velocity]\n";
    return 2;
  }
  robot_control::bench::run(std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10),
                            drives == "velocity" ? WheelCommand::kVelocity : WheelCommand::kTorque);
}
