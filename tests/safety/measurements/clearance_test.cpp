#include "safety/measurements/clearance.h"

#include "safety/monitor_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr double kDelay = 0.05;
constexpr double kDeceleration = 2;

double limit(double parameter) {
  SafetyParameters parameters;
  parameters.clearance = parameter;
  parameters.stop_delay = kDelay;
  parameters.stop_deceleration = kDeceleration;
  return Clearance(parameters, kPeriod).speed_limit({});
}

double topic_limit(double value, double parameter = 0) {
  SafetyParameters parameters;
  parameters.clearance = parameter;
  parameters.stop_delay = kDelay;
  parameters.stop_deceleration = kDeceleration;
  OperatorInput input;
  input.clearances = 1;
  input.clearance = value;
  return Clearance(parameters, kPeriod).speed_limit(input);
}

TEST(ClearanceTest, WithoutAStopDelayAStopTakesThreePeriodsOfASlowLoop) {
  const auto delay = [](double period) {
    SafetyParameters parameters;
    parameters.clearance = 1e-3;
    parameters.stop_deceleration = 1e9;
    return 1e-3 / Clearance(parameters, period).speed_limit({});
  };
  EXPECT_NEAR(delay(0.001), 0.03, 1e-9);
  EXPECT_NEAR(delay(0.05), 0.15, 1e-9);
}

TEST(ClearanceTest, TheRobotStopsExactlyWithinIt) {
  for (const double distance : {1e-9, 1e-3, 0.1, 1.0, 30.0, 1e6}) {
    const double v = limit(distance);
    EXPECT_NEAR(v * kDelay + v * v / (2 * kDeceleration), distance, 1e-12 * distance);
  }
}

TEST(ClearanceTest, ZeroAsAParameterIsUnlimited) {
  EXPECT_EQ(limit(0), kNoSpeedLimit);
}

TEST(ClearanceTest, TheTopicGoesBeforeTheParameter) {
  EXPECT_EQ(topic_limit(1.0, 0.1), limit(1.0));
  EXPECT_EQ(topic_limit(kInfinity, 0.1), kNoSpeedLimit);
}

TEST(ClearanceTest, NoDistanceOnTheTopicIsNoSpeed) {
  for (const double distance : {0.0, -0.0, -1.0, -kInfinity, kNaN}) EXPECT_EQ(topic_limit(distance), 0) << distance;
}

TEST(ClearanceTest, NeverOverflows) {
  EXPECT_EQ(topic_limit(std::numeric_limits<double>::max()), kNoSpeedLimit);
  EXPECT_GT(topic_limit(0.999 * kNoSpeedLimit), 1e4);
  EXPECT_GE(topic_limit(std::numeric_limits<double>::denorm_min()), 0);
}

// v²/4 + 0.03 v = 0.5 m
TEST_F(MonitorTest, AClearanceLimitsTheSpeedInItsCycleAndLatchesNothing) {
  drive();
  EXPECT_EQ(permit_.speed_limit, kNoSpeedLimit);
  input_.operator_input.clearances = 1;
  input_.operator_input.clearance = 0.5;
  step();
  EXPECT_NEAR(permit_.speed_limit, 1.3555, 1e-4);
  input_.operator_input.clearance = 0;
  step();
  EXPECT_EQ(permit_.speed_limit, 0);
  EXPECT_EQ(permit_.state, SupervisorState::kDrive);
  target(0);
  turn_wheels(0);
  steps(250);
  EXPECT_EQ(permit_.causes, 0u);
}

// After ramp_time (0.3 s), and twice that at most, no wheel may be faster than 1.2 · 0.2 m/s + 0.05 m/s = 2.9 rad/s.
TEST_F(MonitorTest, AControllerThatDoesNotSlowDownIsStopped) {
  begin_with(without_heartbeat());
  drive();
  input_.operator_input.clearances = 1;
  input_.operator_input.clearance = 0.016;  // 0.2 m/s
  step();
  ASSERT_NEAR(permit_.speed_limit, 0.2, 1e-2);
  steps(kRamp - 10);
  EXPECT_EQ(permit_.causes, 0u);
  steps(kRamp + 10 + 200);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseWheelSpeed});
}

TEST_F(MonitorTest, AControllerThatSlowsDownInTimeIsNot) {
  begin_with(without_heartbeat());
  drive();
  input_.operator_input.clearances = 1;
  input_.operator_input.clearance = 0.026;
  steps(kRamp - 50);
  target(2);
  turn_wheels(2);
  steps(2000);
  EXPECT_EQ(permit_.causes, 0u);
}

}  // namespace robot_control::tests
