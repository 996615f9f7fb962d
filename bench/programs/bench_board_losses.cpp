/// bench_board_losses FIRST RUNS measures for how long a wheel is driven after a loss, in virtual time. At a random
/// moment a board on a serial line loses its cable, its supply or its driver. Plugged in again the wheels stay braked.
/// They turn after the reset and a new command. After a killed driver they stay braked until the new one orders.

#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "bench/programs/rows.h"
#include "drivers/board/board_machine.h"
#include "drivers/roboclaw/roboclaw_machine.h"

namespace robot_control::bench {

constexpr double kRate = 1000;
constexpr double kSpeed = 10;      // rad/s
constexpr double kStanding = 0.5;  // rad/s
constexpr double kDriving = 0.01;  // N·m along the motion
constexpr double kDrag = 0.05;     // N·m·s/rad, which a driven wheel needs torque for
constexpr double kStepMs = 1;      // of the loop, in which the loss falls
constexpr std::string_view kKilled = "killed";

struct Loss {
  std::string_view name, component, kind;
};
constexpr std::array kLosses{Loss{"cable", "line", "cut"}, Loss{"line stalled", "line", "stalled"},
                             Loss{"reset", "board", "reset"}, Loss{"brown-out", "board", "brown_out"},
                             Loss{"driver killed", "", kKilled}};

struct Outcome {
  double driven_ms = 0;  // after the loss
  bool good = true;
};

template <class Machine>
class Trial {
 public:
  explicit Trial(const JointCommand& driving) : driving_(2, driving) {}

  Outcome run(const Loss& loss, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    machine_.start();
    cycles(static_cast<int>(1000 + random() % 200), driving_);
    Outcome outcome{.good = turns()};
    const bool killed = loss.kind == kKilled;
    if (!killed && !machine_.board().inject(loss.component, loss.kind).empty()) return {.good = false};
    for (int cycle = 1; cycle <= 1000; ++cycle) {
      if (killed) {
        machine_.run_board();
        drag();
      } else {
        cycles(1, driving_);
      }
      if (driven()) outcome.driven_ms = cycle * kStepMs;
    }
    if (killed) {
      machine_.replace_driver();
      machine_.start();
    } else {
      outcome.good = outcome.good && sensors_.driver_state == DriverState::kFault && !machine_.warning().empty();
      machine_.board().inject(loss.component, "ok");
      cycles(1000, driving_);
    }
    outcome.good = outcome.good && stands();
    machine_.reset();
    cycles(500, std::vector<JointCommand>(2));
    outcome.good = outcome.good && stands() && sensors_.driver_state == DriverState::kRunning;
    cycles(1500, driving_);
    outcome.good = outcome.good && turns();
    return outcome;
  }

 private:
  void cycles(int count, const std::vector<JointCommand>& commands) {
    for (int i = 0; i < count; ++i) {
      machine_.read(sensors_);
      machine_.write(commands);
      drag();
    }
  }
  void drag() {
    for (JointSample& joint : machine_.joints) joint.velocity *= 1 - kDrag / Machine::kInertia * machine_.period();
  }
  bool driven() {
    for (std::size_t i = 0; i < 2; ++i) {
      if (machine_.board().torque(i) * std::copysign(1.0, machine_.joints[i].velocity) > kDriving &&
          std::abs(machine_.joints[i].velocity) > kStanding)
        return true;
    }
    return false;
  }
  bool turns() const {
    return std::abs(machine_.joints[0].velocity - kSpeed) < 1 && std::abs(machine_.joints[1].velocity - kSpeed) < 1;
  }
  bool stands() const {
    return std::abs(machine_.joints[0].velocity) < kStanding && std::abs(machine_.joints[1].velocity) < kStanding;
  }

  Machine machine_{kRate};
  SensorFrame sensors_;
  std::vector<JointCommand> driving_;
};

template <class Machine>
void add_board(std::vector<Row>& rows, const std::string& name, double watchdog_ms, const JointCommand& driving,
               std::uint64_t first, std::uint64_t runs) {
  for (const Loss& loss : kLosses) {
    double broken = 0, longest_ms = 0;
    for (std::uint64_t seed = first; seed < first + runs; ++seed) {
      const Outcome outcome = Trial<Machine>(driving).run(loss, seed);
      longest_ms = std::max(longest_ms, outcome.driven_ms);
      if (outcome.good) continue;
      broken += 1;
      std::cerr << name << ", " << loss.name << ", seed " << seed << ": a rule was broken\n";
    }
    const std::string what = name + " " + std::string(loss.name) + " on blocks: ";
    const double allowed_ms = watchdog_ms + 2 * kStepMs;
    rows.push_back({what + "losses that broke a rule", broken, "", 0, "what is allowed", broken});
    rows.push_back(
        {what + "driven after it", longest_ms, "ms", allowed_ms, "what is allowed", longest_ms / allowed_ms});
  }
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  using namespace robot_control;
  if (argc != 3) {
    std::cerr << "usage: bench_board_losses FIRST RUNS\n";
    return 2;
  }
  const std::uint64_t first = std::strtoull(argv[1], nullptr, 10), runs = std::strtoull(argv[2], nullptr, 10);
  std::vector<bench::Row> rows;
  bench::add_board<BoardMachine>(rows, "board", 50, {.mode = JointMode::kVelocity, .velocity = 10, .damping = 2}, first,
                                 runs);
  bench::add_board<RoboclawMachine>(rows, "roboclaw", 100, {.mode = JointMode::kDriveVelocity, .velocity = 10}, first,
                                    runs);
  bench::print("board_losses", rows);
  return 0;
}
