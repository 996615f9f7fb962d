/// Measures the time until the brake acts, node by node, in 20 of 20 trials; `scripts/bench stops` makes 200 of 200.
/// ALostNode (signal_test.cpp) has one trial of five of the nine pairs of node and signal every day.

#include "losses_fixture.h"
#include "support/processes/stop_trials.h"

namespace robot_control::tests {

using CellTrials = std::tuple<LossCell, int>;  // how often

class StopTime : public ::testing::TestWithParam<CellTrials> {};

TEST_P(StopTime, IsAtMost20CyclesInEveryTrial) {
  const auto& [cell, count] = GetParam();
  DrivingRobot robot(DrivingRobot::quick(kParams));
  const StopTrials trials = run_trials(robot, cell, count);
  std::printf("  %s: %s\n", to_text(cell).c_str(), to_text(trials).c_str());
  EXPECT_EQ(trials.cycles.size(), static_cast<std::size_t>(count));
  EXPECT_LE(greatest_of(trials.cycles), static_cast<double>(kBrakeWithin));
}

std::string name_of_cell(const ::testing::TestParamInfo<CellTrials>& each) {
  return to_name(std::get<LossCell>(each.param));
}

INSTANTIATE_TEST_SUITE_P(Nightly, StopTime, ::testing::Combine(::testing::ValuesIn(kLossCells), ::testing::Values(20)),
                         name_of_cell);

}  // namespace robot_control::tests
