/// Tests the limits that are derived if they are not given. The robot has two wheels of 3.5 N·m, 0.005 kg·m² and 30
/// rad/s, commanded at most 15 rad/s.

#include "safety/derived_limits.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr double kRounding = 1e-12;
constexpr double kCommanded = 15;

struct DerivedLimits : testing::Test {
  DerivedLimits() {
    robot_.joints.resize(2);
    robot_.wheels.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
      robot_.joints[i].effort_limit = 3.5;
      robot_.joints[i].velocity_limit = 30;
      robot_.wheels[i].joint = i;
      robot_.wheels[i].inertia = 0.005;
    }
  }

  SafetyParameters limits(double commanded = kCommanded) const { return derived_limits(given_, robot_, commanded); }
  double wheel_speed(double commanded = kCommanded) const { return limits(commanded).wheel_speed.limit.value(); }

  DriveTrain robot_;
  SafetyParameters given_;
};

TEST_F(DerivedLimits, LeaveAQuarterAboveTheFastestCommand) {
  EXPECT_NEAR(wheel_speed(), 18.75, kRounding);
}

TEST_F(DerivedLimits, OfSpeedAreThoseOfTheSlowestWheelWhereItBearsLess) {
  robot_.joints[1].velocity_limit = 17;
  EXPECT_NEAR(wheel_speed(), 17, kRounding);
}

TEST_F(DerivedLimits, LeaveATenthEvenWhereTheCommandReachesTheWheelsOwnLimit) {
  robot_.joints[1].velocity_limit = 15;
  EXPECT_NEAR(wheel_speed(), 16.5, kRounding);
}

TEST_F(DerivedLimits, ExpectNoCommandBeyondTheWheelsOwnLimit) {
  robot_.joints[1].velocity_limit = 12;
  EXPECT_NEAR(wheel_speed(), 13.2, kRounding) << "the controller saturates at 12";
}

TEST_F(DerivedLimits, OfSpeedNeedNoVelocityLimit) {
  for (JointModel& joint : robot_.joints) joint.velocity_limit = 0;
  EXPECT_NEAR(wheel_speed(), 18.75, kRounding);
}

TEST_F(DerivedLimits, LeaveASlowRobotRoomForWhatEncodersCannotTell) {
  EXPECT_NEAR(wheel_speed(0.2), 0.2 + kSpeedMargin, kRounding);
}

TEST_F(DerivedLimits, OfAccelerationAreTwiceTheMotorsAndAStopWithinTheWindow) {
  EXPECT_NEAR(limits().wheel_acceleration.limit.value(), 2 * 3.5 / 0.005 + 18.75 / 0.02, 1e-9);
  robot_.wheels[1].inertia = 0.001;
  EXPECT_NEAR(limits().wheel_acceleration.limit.value(), 2 * 3.5 / 0.001 + 18.75 / 0.02, 1e-9)
      << "the lightest wheel's";
}

TEST_F(DerivedLimits, OfPowerAreAllMotorsAtBothTheirLimits) {
  EXPECT_NEAR(limits().power.limit.value(), 2 * 3.5 * 18.75, kRounding);
}

TEST_F(DerivedLimits, OfRunawayAreAFifthOfTheSpeedLimitButNeverLessThanTwo) {
  EXPECT_NEAR(limits().runaway.limit.value(), 3.75, kRounding);
  EXPECT_NEAR(limits(1).runaway.limit.value(), kMinRunaway, kRounding);
  EXPECT_NEAR(derived_limits(given_, robot_, kCommanded, 0.01).runaway.limit.value(), 2 * 3.75, kRounding)
      << "slow loops";
}

TEST_F(DerivedLimits, OfStallAreMoreWhereWheelsDragEachOtherAndWhereLoopsAreSlow) {
  EXPECT_EQ(limits().stall.limit, kStall);
  EXPECT_NEAR(derived_limits(given_, robot_, kCommanded, 0.01).stall.limit.value(), 10 * kStall, kRounding);
  EXPECT_EQ(derived_limits(given_, robot_, kCommanded, 0.0005).stall.limit, kStall);
  robot_.wheels.resize(4, robot_.wheels[0]);
  EXPECT_EQ(limits().stall.limit, kScrubbingStall);
}

// The window over which a speed is measured has two periods at least.
TEST_F(DerivedLimits, OfTheAccelerationFollowTheWindowOfASlowLoop) {
  const auto wall = [this](double period) {
    const SafetyParameters limits = derived_limits(given_, robot_, kCommanded, period);
    const JointModel& joint = robot_.joints[robot_.wheels[0].joint];
    const double motor = 2 * joint.effort_limit / robot_.wheels[0].inertia;
    return (*limits.wheel_acceleration.limit - motor) / *limits.wheel_speed.limit;
  };
  EXPECT_NEAR(wall(0.01), 1 / 0.02, 1e-9);
  EXPECT_NEAR(wall(0.05), 1 / 0.1, 1e-9);
}

TEST_F(DerivedLimits, OfNotStoppingAreLongerOnlyWhereLoopsAreSlow) {
  EXPECT_EQ(limits().not_stopping.limit, kNotStopping);
  EXPECT_NEAR(derived_limits(given_, robot_, kCommanded, 0.01).not_stopping.limit.value(), 2 * kNotStopping, kRounding);
}

TEST_F(DerivedLimits, FollowASpeedLimitThatIsGiven) {
  given_.wheel_speed.limit = 40;
  EXPECT_EQ(wheel_speed(), 40);
  EXPECT_NEAR(limits().power.limit.value(), 2 * 3.5 * 40, kRounding);
  EXPECT_NEAR(limits().runaway.limit.value(), 8, kRounding);
}

TEST_F(DerivedLimits, LeaveWhatIsGiven) {
  for (Condition* condition : {&given_.wheel_acceleration, &given_.power, &given_.runaway}) condition->limit = 1.5;
  const SafetyParameters result = limits();
  EXPECT_EQ(result.wheel_acceleration.limit, 1.5);
  EXPECT_EQ(result.power.limit, 1.5);
  EXPECT_EQ(result.runaway.limit, 1.5);
}

TEST_F(DerivedLimits, InventNoBattery) {
  EXPECT_FALSE(limits().battery_low.limit);
  EXPECT_FALSE(limits().battery_empty.limit);
}

}  // namespace robot_control::tests
