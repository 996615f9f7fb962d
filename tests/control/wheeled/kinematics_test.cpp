#include "control/wheeled/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/wheeled/test_robot.h"

namespace robot_control::tests {

constexpr double kRounding = 1e-14;  // a few operations on numbers of order one to ten

TEST(DriveKinematics, TurnsTheArticlesTwistIntoItsWheelSpeeds) {
  const SidePair rim = DriveKinematics(make_test_robot()).rim_speeds({0.5, 0.2});
  EXPECT_NEAR(rim.left, 0.45, kRounding);
  EXPECT_NEAR(rim.right, 0.55, kRounding);
}

TEST(DriveKinematics, DividesByTheRadiusOfEachWheelAndHonoursItsSign) {
  DriveTrain robot = make_test_robot();
  robot.wheels[0].radius = 0.09;
  robot.wheels[1].sign = -1;
  const WheelValues joint = DriveKinematics(robot).joint_speeds({0.5, 0.2});
  EXPECT_NEAR(joint[0], 0.45 / 0.09, kRounding);
  EXPECT_NEAR(joint[1], -0.55 / 0.1, kRounding);
}

TEST(DriveKinematics, GivesBackTheTwistItWasGiven) {
  DriveTrain robot = make_test_robot();
  robot.wheels[0].radius = 0.09;
  robot.wheels[0].sign = -1;
  for (const DriveTrain& model : {robot, make_skid_steer()}) {
    const DriveKinematics kinematics(model);
    for (unsigned seed = 0; seed < 100; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> any(-2, 2);
      const PlanarTwist twist{any(random), any(random)};
      const PlanarTwist back = kinematics.twist(kinematics.joint_speeds(twist));
      EXPECT_NEAR(back.linear, twist.linear, kRounding) << "seed " << seed;
      EXPECT_NEAR(back.angular, twist.angular, kRounding) << "seed " << seed;
    }
  }
}

// 0.41 m from the middle to where the wheels seem to roll: the rims differ by 0.2 rad/s · 0.82 m.
TEST(DriveKinematics, TurnsWheelsBehindEachOtherFasterByTheEffectiveWheelBase) {
  const DriveKinematics kinematics(make_skid_steer());
  const SidePair rim = kinematics.rim_speeds({0.5, 0.2});
  EXPECT_NEAR(rim.left, 0.5 - 0.2 * 0.41, kRounding);
  EXPECT_NEAR(rim.right, 0.5 + 0.2 * 0.41, kRounding);
  const WheelValues joint = kinematics.joint_speeds({0.5, 0.2});
  for (const std::size_t left : {0u, 1u}) EXPECT_NEAR(joint[left], -4.18, 10 * kRounding);
  for (const std::size_t right : {2u, 3u}) EXPECT_NEAR(joint[right], 5.82, 10 * kRounding);
}

TEST(DriveKinematics, MeasuresTheMeanOfTheRimsOfASide) {
  const DriveKinematics kinematics(make_skid_steer());
  const PlanarTwist twist = kinematics.twist({-4, -6, 7, 3});  // rims 0.4, 0.6 and 0.7, 0.3 m/s
  EXPECT_NEAR(twist.linear, 0.5, kRounding);
  EXPECT_NEAR(twist.angular, 0, kRounding);
}

TEST(DriveKinematics, IsLimitedByTheSlowestWheelOfASide) {
  DriveTrain robot = make_skid_steer();
  robot.joints[3].velocity_limit = 4;  // 0.4 m/s
  EXPECT_NEAR(DriveKinematics(robot).wheel_speed_scale({0.8, 0}), 0.9 * 0.5, kRounding);
}

TEST(DriveKinematics, ScalesBothAxesUntilTheFastestWheelIsAtNineTenthsOfItsLimit) {
  const DriveTrain robot = make_test_robot();  // 30 rad/s · 0.1 m = 3 m/s
  const DriveKinematics kinematics(robot);
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-8, 8);
    const PlanarTwist twist{any(random), any(random)};
    const double scale = kinematics.wheel_speed_scale(twist);
    const WheelValues requested = kinematics.joint_speeds(twist);
    const double fastest = std::fmax(std::abs(requested[0]), std::abs(requested[1]));
    EXPECT_NEAR(scale, fastest > 27 ? 27 / fastest : 1, kRounding) << "seed " << seed;
  }
}

TEST(DriveKinematics, HasNoWheelLimitWhereTheRobotNamesNone) {
  DriveTrain robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.velocity_limit = 0;
  EXPECT_EQ(DriveKinematics(robot).wheel_speed_scale({1000, 0}), 1);
}

}  // namespace robot_control::tests
