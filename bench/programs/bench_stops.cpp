/// bench_stops PARAMS.yaml: measures the time until the brake acts, and the way of the robot until then.
///
/// Wall clock: one of four processes at 1 m/s gets a signal, 200 times each. The count runs in cycles of the plant,
/// from the newest cycle before the signal to the first one of the lasting brake. The way is that to standstill.
/// Virtual time: the facts that the simulated machine can produce, cause by cause (stop_budget.h).

#include <iostream>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "bench/programs/stop_budget.h"
#include "support/processes/stop_trials.h"

namespace robot_control::bench {

constexpr int kTrials = 200;
constexpr double kPromised = 20;  // cycles

std::vector<Row> lost_nodes(const std::string& path) {
  std::vector<Row> rows;
  for (const LossCell& cell : kLossCells) {
    DrivingRobot robot(DrivingRobot::quick(path));
    const StopTrials trials = run_trials(robot, cell, kTrials);
    const std::string name = to_text(cell);
    const double worst = greatest_of(trials.cycles);
    std::cerr << name << ": " << to_text(trials) << "\n";
    rows.push_back({name + ": brake", median_of(trials.cycles), "cycles, median", kPromised, "the promise",
                    median_of(trials.cycles) / kPromised});
    rows.push_back({name + ": brake", worst, "cycles, worst of 200", kPromised, "the promise", worst / kPromised});
    rows.push_back({name + ": way", greatest_of(trials.ways), "m, worst of 200", 0, "none", 0});
  }
  return rows;
}

std::vector<Row> virtual_time(const std::string& path) {
  std::vector<StopMeasurement> measured;
  for (const StopScenario& scenario : stop_scenarios()) measured.push_back(measure_stop(path, scenario));
  return stop_rows(measured);
}

void run(const std::string& path) {
  std::vector<Row> rows = lost_nodes(path);
  for (const Row& row : virtual_time(path)) rows.push_back(row);
  print("stops", rows);
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  return robot_control::bench::run_with_parameters(argc, argv, robot_control::bench::run);
}
