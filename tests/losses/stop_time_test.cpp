/// How long the brake takes to come, node by node: 20 of 20 trials. 200 of 200: `scripts/bench stops`.

#include "losses_fixture.h"
#include "support/stop_trials.h"

namespace robot_control {
namespace {

constexpr int kTrials = 20;

class StopTime : public ::testing::TestWithParam<LossCell> {};

TEST_P(StopTime, IsAtMost20CyclesIn20Of20Trials) {
  DrivingRobot robot(DrivingRobot::quick(kParams));
  const StopTrials trials = run_trials(robot, GetParam(), kTrials);
  std::printf("  %s: %s\n", to_text(GetParam()).c_str(), to_text(trials).c_str());
  EXPECT_EQ(trials.cycles.size(), static_cast<std::size_t>(kTrials));
  EXPECT_LE(greatest_of(trials.cycles), static_cast<double>(kBrakeWithin));
}

INSTANTIATE_TEST_SUITE_P(Each, StopTime, ::testing::ValuesIn(kLossCells),
                         [](const auto& each) { return to_name(each.param); });

}  // namespace
}  // namespace robot_control
