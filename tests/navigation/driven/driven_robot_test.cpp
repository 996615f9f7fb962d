#include "navigation/driven/driven_robot.h"

#include <cmath>

#include "control/legged/stand/nominal_stance.h"
#include "support/matchers.h"

namespace robot_control::navigation::tests {

struct DrivenRobotTest : testing::Test {
  DrivenRobot robot(const std::string& name) const {
    return driven_robot(load_description(PROJECT_DIRECTORY "/urdf/" + name + ".urdf"), parameters);
  }
  Parameters parameters;
};

TEST_F(DrivenRobotTest, OnWheelsTheOutlineIsThatOfTheShapes) {
  const DrivenRobot diffbot = robot("diffbot");
  EXPECT_NEAR(diffbot.outline.half_width, 0.27, 1e-3);
  EXPECT_EQ(diffbot.limits.lateral, 0);
  EXPECT_EQ(diffbot.limits.forward, parameters.controller.max_linear_speed);
}

TEST_F(DrivenRobotTest, OnLegsTheOutlineHoldsTheFeetOfAStride) {
  const auto description = load_description(PROJECT_DIRECTORY "/urdf/quadbot.urdf");
  const NominalStance stance = nominal_stance(read_legs(description, parameters.robot, parameters.legs));
  const DrivenRobot quadbot = robot("quadbot");
  const double half = 0.15;  // s, half of a stance of walking_trot
  for (const Eigen::Vector3d& foot : stance.feet) {
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_LE(quadbot.outline.distance({foot.x() + sign * half * parameters.navigate.speed, foot.y()}), 0);
      EXPECT_LE(quadbot.outline.distance({foot.x(), foot.y() + sign * half * kMaxLateral}), 0);
    }
  }
  EXPECT_LT(quadbot.outline.half_width, 0.35);
  EXPECT_EQ(quadbot.limits.lateral, kMaxLateral);
}

TEST_F(DrivenRobotTest, ASlowerRobotTakesShorterStrides) {
  const double before = robot("quadbot").outline.distance({2, 0});
  parameters.navigate.speed = 0.1;
  EXPECT_GT(robot("quadbot").outline.distance({2, 0}), before + 0.02);
}

/// A local controller plans within the limits that the robot's controller has at the moment.
struct ControllerLimitsTest : testing::Test {
  DriveLimits after(const std::string& name, double value) {
    set_in_force(robot_, name, value);
    return robot_.limits;
  }
  DrivenRobot robot_ = driven_robot(load_description(PROJECT_DIRECTORY "/urdf/diffbot.urdf"), Parameters());
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
  const DriveLimits before = robot_.limits;
  for (const double wrong : {0.0, -1.0, 1e9, std::nan(""), HUGE_VAL})
    EXPECT_EQ(after("max_linear_acceleration", wrong).linear_acceleration, before.linear_acceleration) << wrong;
  EXPECT_EQ(after("mass", 3).forward, before.forward);
}

}  // namespace robot_control::navigation::tests
