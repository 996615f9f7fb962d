// Checks that a local controller plans within the limits that the robot's controller has at the moment.
#include "ros/navigation/controller_limits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "navigation/driven/driven_robot.h"

namespace robot_control::navigation::tests {

struct ControllerLimitsTest : testing::Test {
  DriveLimits after(const std::string& name, double value) {
    dynamic_reconfigure::Config message;
    message.doubles.emplace_back();
    message.doubles.back().name = name;
    message.doubles.back().value = value;
    take_over(message, wheels_);
    return limits_of(wheels_);
  }
  DriveControllerParameters wheels_;
};

TEST_F(ControllerLimitsTest, TheyFollowWhatIsSetWhileTheRobotDrives) {
  EXPECT_EQ(after("max_linear_acceleration", 0.3).linear_acceleration, 0.3);
  EXPECT_EQ(after("max_linear_speed", 0.2).forward, 0.2);
  EXPECT_EQ(after("max_linear_speed", 0.2).reverse, 0.2);
  EXPECT_EQ(after("min_linear_speed", -0.1).reverse, 0.1);
  EXPECT_EQ(after("max_angular_speed", 0.4).angular, 0.4);
  EXPECT_EQ(after("max_angular_acceleration", 0.5).angular_acceleration, 0.5);
}

TEST_F(ControllerLimitsTest, TheRobotBrakesNoShorterThanItsDeceleration) {
  EXPECT_EQ(after("max_linear_deceleration", 0.2).linear_acceleration, 0.2);
  EXPECT_EQ(after("max_linear_deceleration_reverse", 0.1).linear_acceleration, 0.1);
  EXPECT_EQ(after("max_linear_deceleration_reverse", 5).linear_acceleration, 0.2);
}

TEST_F(ControllerLimitsTest, OtherValuesAreLeftOut) {
  const DriveLimits before = limits_of(wheels_);
  for (const double wrong : {0.0, -1.0, 1e9, std::nan(""), HUGE_VAL})
    EXPECT_EQ(after("max_linear_acceleration", wrong).linear_acceleration, before.linear_acceleration) << wrong;
  EXPECT_EQ(after("mass", 3).forward, before.forward);
}

}  // namespace robot_control::navigation::tests
