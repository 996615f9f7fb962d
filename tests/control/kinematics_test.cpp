#include "control/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/test_robot.h"

namespace robot_control {
namespace {

constexpr double kRounding = 1e-14;  // a few operations on numbers of order one to ten

TEST(DriveKinematics, TurnsTheArticlesTwistIntoItsWheelSpeeds) {
  const WheelPair rim = DriveKinematics(make_test_robot()).rim_speeds({0.5, 0.2});
  EXPECT_NEAR(rim.left, 0.45, kRounding);
  EXPECT_NEAR(rim.right, 0.55, kRounding);
}

TEST(DriveKinematics, DividesByTheRadiusOfEachWheelAndHonoursItsSign) {
  RobotModel robot = make_test_robot();
  robot.left.radius = 0.09;
  robot.right.sign = -1;
  const WheelPair joint = DriveKinematics(robot).joint_speeds({0.5, 0.2});
  EXPECT_NEAR(joint.left, 0.45 / 0.09, kRounding);
  EXPECT_NEAR(joint.right, -0.55 / 0.1, kRounding);
}

TEST(DriveKinematics, GivesBackTheTwistItWasGiven) {
  RobotModel robot = make_test_robot();
  robot.left.radius = 0.09;
  robot.left.sign = -1;
  const DriveKinematics kinematics(robot);
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-2, 2);
    const PlanarTwist twist{any(random), any(random)};
    const PlanarTwist back = kinematics.twist(kinematics.joint_speeds(twist));
    EXPECT_NEAR(back.linear, twist.linear, kRounding) << "seed " << seed;
    EXPECT_NEAR(back.angular, twist.angular, kRounding) << "seed " << seed;
  }
}

TEST(DriveKinematics, ScalesBothAxesUntilTheFastestWheelIsAtItsLimit) {
  const RobotModel robot = make_test_robot();  // 30 rad/s · 0.1 m = 3 m/s
  const DriveKinematics kinematics(robot);
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-8, 8);
    const PlanarTwist twist{any(random), any(random)};
    const double scale = kinematics.wheel_speed_scale(twist);
    const WheelPair wish = kinematics.joint_speeds(twist);
    const double fastest = std::fmax(std::abs(wish.left), std::abs(wish.right));
    EXPECT_NEAR(scale, fastest > 30 ? 30 / fastest : 1, kRounding) << "seed " << seed;
  }
}

TEST(DriveKinematics, HasNoWheelLimitWhereTheRobotNamesNone) {
  RobotModel robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.velocity_limit = 0;
  EXPECT_EQ(DriveKinematics(robot).wheel_speed_scale({1000, 0}), 1);
}

}  // namespace
}  // namespace robot_control
