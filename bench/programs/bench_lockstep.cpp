/// bench_lockstep PARAMS.yaml: the closed loop in virtual time against the bare physics engine.
///
/// Each round runs three loops, one after the other: `mj_step` of the same model, the ClosedLoop in this process, and
/// four processes in lockstep on a bus of their own. The figures are simulated seconds per second, median over the
/// rounds, and the ratio to the bare loop of the same round.

#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "support/processes/loop_speed.h"

namespace robot_control::bench {

constexpr int kRounds = 7;
constexpr std::uint64_t kCycles = 40'000;

void run(const std::string& path) {
  const Parameters parameters = read_parameters(path);
  const DriveTrain robot = read_drive_train(load_description(parameters.urdf), parameters.robot);
  std::vector<double> bare;
  std::vector<double> closed;
  std::vector<double> four;
  for (int round = 0; round < kRounds; ++round) {
    bare.push_back(bare_loop_speed(parameters, robot, kCycles));
    closed.push_back(closed_loop_speed(parameters, kCycles));
    four.push_back(four_nodes_speed(parameters, robot, kCycles));
  }
  const std::string unit = "simulated s per s";
  const std::string reference = "bare mj_step loop";
  print("lockstep", {{reference, median(bare), unit, median(bare), "itself", 1},
                     {"ClosedLoop", median(closed), unit, median(bare), reference, median_ratio(closed, bare)},
                     {"four processes", median(four), unit, median(bare), reference, median_ratio(four, bare)}});
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  return robot_control::bench::run_with_parameters(argc, argv, robot_control::bench::run);
}
