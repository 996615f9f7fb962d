#include "control/wheeled/smooth_speed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "control/wheeled/test_robot.h"

namespace robot_control::tests {

constexpr double kCoarseCount = 2 * std::numbers::pi / 90;

double smooth_from(const DriveControllerParameters& parameters, const DriveTrain& robot = make_test_robot()) {
  return smooth_speed(parameters, robot, kCoarseCount, 1e-3);
}

// Computes the law of the header step by step: the torque grows with ki·v from the wheel's first motion on.
TEST(SmoothSpeed, IsWhereTorqueThatGrowsUntilTheFirstCountReachesThePlannedSpeed) {
  const double inertia = 0.045, ki = 20, radius = 0.1;  // turning; derived gains
  const double planned = smooth_from({}) / radius;
  double torque = 0, speed = 0, angle = 0;
  for (const double dt = 1e-6; angle < kCoarseCount; angle += dt * speed) {
    torque += ki * planned * dt;
    speed += torque / inertia * dt;
  }
  EXPECT_NEAR(speed, planned, 1e-3 * planned);
}

// Turning 0.005 + 2·0.5·0.01/(2·0.5·0.82) = 0.0172 kg·m², straight 0.065.
TEST(SmoothSpeed, HasTheTreadsOfASkidSteerGiveFirst) {
  DriveControllerParameters set;
  set.pid_kp = 2;
  set.pid_ki = 20;
  const double inertia = 0.005 + 0.01 / 0.82;
  EXPECT_NEAR(smooth_from(set, make_skid_steer()), 0.1 * (kCoarseCount + kTread) * std::sqrt(4.5 * 20 / inertia), 1e-9);
}

TEST(SmoothSpeed, IsThatOfTheSetGainsAndOfTheMeasuredRobot) {
  DriveControllerParameters slow;
  slow.pid_ki = 5;
  EXPECT_NEAR(smooth_from(slow), 0.5 * smooth_from({}), 1e-9);  // a quarter of the derived ki
  DriveControllerParameters heavy;
  heavy.pid_kp = 2;
  heavy.pid_ki = 20;
  heavy.feed_forward.mass = 1000;
  heavy.feed_forward.yaw_inertia = 50;  // 100 times, but for the wheels' own
  EXPECT_NEAR(smooth_from(heavy), smooth_from({}) * std::sqrt(0.045 / (0.005 + 4.0)), 1e-9);
  DriveControllerParameters without;
  without.pid_ki = 0;
  EXPECT_EQ(smooth_from(without), 0);
}

}  // namespace robot_control::tests
