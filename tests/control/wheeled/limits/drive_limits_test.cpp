#include "control/wheeled/limits/drive_limits.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace robot_control::tests {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Acceleration 1 m/s² and 3 rad/s².
DriveControllerParameters plain() {
  DriveControllerParameters parameters;
  parameters.max_linear_speed = 1.5;
  parameters.max_angular_speed = 2.5;
  parameters.max_linear_acceleration = 1;
  parameters.max_angular_acceleration = 3;
  return parameters;
}

TEST(DriveLimits, LeftOutFollowFromTheAccelerations) {
  const SpeedLimits limits = speed_limits(plain());
  EXPECT_EQ(limits.linear.speed, 1.5);
  EXPECT_EQ(limits.linear.acceleration, 1);
  EXPECT_EQ(limits.linear.deceleration, 1);
  EXPECT_EQ(limits.linear.emergency_deceleration, 2);
  EXPECT_DOUBLE_EQ(limits.linear.jerk, 10);
  EXPECT_EQ(limits.linear.reverse_speed, 1.5);
  EXPECT_EQ(limits.linear.reverse_acceleration, 1);
  EXPECT_EQ(limits.linear.reverse_deceleration, 1);
  EXPECT_EQ(limits.angular.speed, 2.5);
  EXPECT_EQ(limits.angular.acceleration, 3);
  EXPECT_EQ(limits.angular.deceleration, 3);
  EXPECT_EQ(limits.angular.emergency_deceleration, 6) << "by the factor of the linear one";
  EXPECT_DOUBLE_EQ(limits.angular.jerk, 30);
  EXPECT_TRUE(limits.keep_curvature);
}

TEST(DriveLimits, AreThoseGiven) {
  DriveControllerParameters parameters = plain();
  parameters.max_linear_deceleration = 1.1;
  parameters.max_linear_deceleration_reverse = 1.2;
  parameters.max_linear_acceleration_reverse = 0.7;
  parameters.min_linear_speed = -0.4;
  parameters.max_angular_deceleration = 3.5;
  parameters.max_linear_emergency_deceleration = 4;
  parameters.max_angular_emergency_deceleration = 5;
  parameters.max_linear_jerk = 6;
  parameters.max_angular_jerk = 7;
  parameters.keep_curvature = false;
  const SpeedLimits limits = speed_limits(parameters);
  EXPECT_EQ(limits.linear.deceleration, 1.1);
  EXPECT_EQ(limits.linear.reverse_deceleration, 1.2);
  EXPECT_EQ(limits.linear.reverse_acceleration, 0.7);
  EXPECT_EQ(limits.linear.reverse_speed, 0.4);
  EXPECT_EQ(limits.angular.deceleration, 3.5);
  EXPECT_EQ(limits.linear.emergency_deceleration, 4);
  EXPECT_EQ(limits.angular.emergency_deceleration, 5);
  EXPECT_EQ(limits.linear.jerk, 6);
  EXPECT_EQ(limits.angular.jerk, 7);
  EXPECT_FALSE(limits.keep_curvature);
}

TEST(DriveLimits, FollowTheDecelerationForwardsInReverse) {
  DriveControllerParameters parameters = plain();
  parameters.max_linear_deceleration = 1.4;
  EXPECT_EQ(speed_limits(parameters).linear.reverse_deceleration, 1.4);
  parameters.min_linear_speed = -3;
  EXPECT_EQ(speed_limits(parameters).linear.reverse_speed, 1.5) << "no faster than forwards";
  parameters.min_linear_speed = 0;
  EXPECT_EQ(speed_limits(parameters).linear.reverse_speed, 0);
}

/// Twice the larger deceleration, no more than half of the grip, no less than the deceleration itself.
TEST(DriveLimits, AreBoundedByTheGripInAnEmergency) {
  DriveControllerParameters parameters = plain();
  parameters.max_linear_deceleration_reverse = 2;
  EXPECT_DOUBLE_EQ(speed_limits(parameters).linear.emergency_deceleration, 4);
  EXPECT_DOUBLE_EQ(speed_limits(parameters).angular.emergency_deceleration, 6);
  parameters.max_linear_deceleration = 3.5;
  EXPECT_DOUBLE_EQ(speed_limits(parameters).linear.emergency_deceleration, 4.9);
  EXPECT_DOUBLE_EQ(speed_limits(parameters).angular.emergency_deceleration, 3 * 4.9 / 3.5);
  parameters.max_linear_deceleration = 8;
  EXPECT_DOUBLE_EQ(speed_limits(parameters).linear.emergency_deceleration, 8);
  EXPECT_DOUBLE_EQ(speed_limits(parameters).angular.emergency_deceleration, 3);
  parameters.max_linear_emergency_deceleration = 4;  // less than the deceleration
  EXPECT_DOUBLE_EQ(speed_limits(parameters).angular.emergency_deceleration, 3);
}

TEST(DriveLimits, LetTheLargestAccelerationBuildUpInATenthOfASecond) {
  DriveControllerParameters parameters = plain();
  parameters.max_linear_acceleration_reverse = 2.5;
  EXPECT_DOUBLE_EQ(speed_limits(parameters).linear.jerk, 25);
  parameters.max_linear_acceleration_reverse = 0.5;
  EXPECT_DOUBLE_EQ(speed_limits(parameters).linear.jerk, 10);
  parameters.max_linear_emergency_deceleration = 4;
  EXPECT_DOUBLE_EQ(speed_limits(parameters).linear.jerk, 20) << "half of the emergency deceleration";
  parameters.max_angular_emergency_deceleration = 10;
  EXPECT_DOUBLE_EQ(speed_limits(parameters).angular.jerk, 50);
}

TEST(DriveLimits, HoldNoJerkForAJerkOfZero) {
  EXPECT_EQ(jerk_limit(0), kUnlimited);
  EXPECT_EQ(jerk_limit(0.5), 0.5);
  DriveControllerParameters parameters = plain();
  parameters.max_linear_jerk = 0;
  parameters.max_angular_jerk = 0;
  EXPECT_EQ(speed_limits(parameters).linear.jerk, kUnlimited);
  EXPECT_EQ(speed_limits(parameters).angular.jerk, kUnlimited);
}

TEST(MotionLimits, HoldInReverseBelowZeroAlone) {
  MotionLimits limits{.speed = 1, .acceleration = 2, .deceleration = 3};
  for (const double direction : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(limits.speed_towards(direction), 1);
    EXPECT_EQ(limits.acceleration_towards(direction), 2);
    EXPECT_EQ(limits.deceleration_from(direction), 3);
  }
  limits.reverse_speed = 4;
  limits.reverse_acceleration = 5;
  limits.reverse_deceleration = 6;
  for (const double direction : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(limits.speed_towards(direction), direction < 0 ? 4 : 1);
    EXPECT_EQ(limits.acceleration_towards(direction), direction < 0 ? 5 : 2);
    EXPECT_EQ(limits.deceleration_from(direction), direction < 0 ? 6 : 3);
  }
}

TEST(SpeedLimits, AreThoseOfTheHeaderWithoutParameters) {
  const SpeedLimits limits;
  EXPECT_EQ(limits.linear.speed, 1);
  EXPECT_EQ(limits.linear.acceleration, 1);
  EXPECT_EQ(limits.linear.deceleration, 1);
  EXPECT_EQ(limits.linear.emergency_deceleration, 1);
  EXPECT_EQ(limits.angular.speed, 2);
  EXPECT_EQ(limits.angular.acceleration, 4);
  EXPECT_EQ(limits.angular.deceleration, 4);
  EXPECT_EQ(limits.angular.emergency_deceleration, 4);
  EXPECT_TRUE(limits.keep_curvature);
}

/// The share of the limits that a step used: 1 at a limit, whichever axis is there.
TEST(UsedAccelerationScale, IsThatOfTheAxisThatUsesMost) {
  SpeedLimits limits{.linear = {.speed = 5, .acceleration = 1, .deceleration = 2},
                     .angular = {.speed = 5, .acceleration = 4, .deceleration = 8}};
  limits.keep_curvature = false;
  SpeedLimiter limiter(limits);
  EXPECT_EQ(limiter.used_acceleration_scale(), 0);
  limiter.step({1, 0.0004}, 0.001);
  EXPECT_NEAR(limiter.used_acceleration_scale(), 1, 1e-12);
  limiter.step({0.001, 1}, 0.001);
  EXPECT_NEAR(limiter.used_acceleration_scale(), 1, 1e-12);
  limiter.restart_from({1, 0});
  limiter.step({0.9995, 0}, 0.001);
  EXPECT_NEAR(limiter.used_acceleration_scale(), 0.25, 1e-9) << "0.5 m/s² of the deceleration";
  limiter.restart_from({0, 0});
  limiter.step({1, 1}, 0.001, false, 0.5);
  EXPECT_NEAR(limiter.acceleration().linear, 0.5, 1e-9);
  EXPECT_NEAR(limiter.acceleration().angular, 2, 1e-9);
  EXPECT_NEAR(limiter.used_acceleration_scale(), 0.5, 1e-9) << "of the user's limits";
}

/// From 1 at the tighter jerk of both axes: 10/1 and 20/4 per second.
TEST(UsedAccelerationScale, FallsAtTheTighterJerkLimit) {
  SpeedLimiter limiter({.linear = {.speed = 5, .acceleration = 1, .deceleration = 1, .jerk = 10},
                        .angular = {.speed = 5, .acceleration = 4, .deceleration = 4, .jerk = 20}});
  for (int k = 0; k < 600; ++k) limiter.step({3, 0}, 0.001);
  ASSERT_NEAR(limiter.acceleration().linear, 1, 1e-9);
  for (int k = 1; k <= 150; ++k) {
    limiter.step({3, 0}, 0.001, false, 0.5);
    EXPECT_NEAR(limiter.acceleration().linear, std::max(0.5, 1 - 0.005 * k), 1e-9) << k;
  }
}

}  // namespace robot_control::tests
