#include "control/wheeled/wheel_loops/feed_forward.h"

#include <gtest/gtest.h>

#include <random>

#include "control/wheeled/test_robot.h"
#include "control/wheeled/two_wheel_plant.h"

namespace robot_control::tests {

TEST(FeedForward, GivesTheTwelveKilogramRobotItsMeasuredInertias) {
  const DriveTrain robot = make_test_robot();
  EXPECT_NEAR(straight_inertia(robot, robot.wheels[0]), 0.065, 1e-15);
  EXPECT_NEAR(turning_inertia(robot, robot.wheels[0]), 0.045, 1e-15);
}

TEST(FeedForward, IsThatInertiaTimesTheWheelsAcceleration) {
  const FeedForward law(make_test_robot());
  // 1 m/s² is 10 rad/s² of a 0.1 m wheel; 4 rad/s² of yaw is 1 m/s² at the rim.
  EXPECT_NEAR(law.efforts({}, {1, 0})[0], 0.65, 1e-14);
  EXPECT_NEAR(law.efforts({}, {1, 0})[1], 0.65, 1e-14);
  EXPECT_NEAR(law.efforts({}, {0, 4})[0], -0.45, 1e-14);
  EXPECT_NEAR(law.efforts({}, {0, 4})[1], 0.45, 1e-14);
}

// 24 kg · 1 m/s² on four wheels give 6 N · 0.1 m + 0.005 · 10 rad/s². Yaw at 4 rad/s² needs a moment of 2 N·m over the
// lever of 0.5 m, so 4 N a side and 2 N a wheel. Its rim gains 4 · 0.41 m/s², 16.4 rad/s².
TEST(FeedForward, SharesTheLoadOverAllWheels) {
  const DriveTrain robot = make_skid_steer();
  EXPECT_NEAR(straight_inertia(robot, robot.wheels[0]), 0.065, 1e-15);
  EXPECT_NEAR(turning_inertia(robot, robot.wheels[0]), 0.005 + 0.2 / 16.4, 1e-15);
  const FeedForward law(robot);
  const WheelValues straight = law.efforts({}, {1, 0});
  const WheelValues turn = law.efforts({}, {0, 4});
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(straight[i], i < 2 ? -0.65 : 0.65, 1e-14);
    EXPECT_NEAR(turn[i], 0.2 + 0.005 * 16.4, 1e-14);  // left ones backward, their joints are mirrored
  }
}

// 0.5 m/s and 0.2 rad/s turn the wheels with 4.5 and 5.5 rad/s; far above 0.1 rad/s dry friction counts in full.
TEST(FeedForward, OvercomesWhatTheJointItselfTakes) {
  DriveTrain robot = make_test_robot();
  robot.wheels[1].sign = -1;
  for (JointModel& joint : robot.joints) {
    joint.damping = 0.02;
    joint.friction = 0.3;
  }
  const WheelValues efforts = FeedForward(robot).efforts({0.5, 0.2}, {});
  EXPECT_NEAR(efforts[0], 0.02 * 4.5 + 0.3, 1e-12);
  EXPECT_NEAR(efforts[1], -(0.02 * 5.5 + 0.3), 1e-12);
  EXPECT_EQ(FeedForward(robot).efforts({}, {})[0], 0);
}

TEST(FeedForward, AcceleratesARigidRobotExactlyAsPlanned) {
  DriveTrain robot = make_test_robot();
  robot.centre_of_gravity_base[0] = 0.05;
  robot.wheels[1].sign = -1;
  const FeedForward law(robot);
  const double dt = 1e-3;
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-2, 2);
    TwoWheelPlant plant(robot);
    plant.twist = {any(random), any(random)};
    const PlanarTwist before = plant.twist;
    const PlanarTwist acceleration{any(random), any(random)};
    const WheelValues efforts = law.efforts(before, acceleration);
    plant.drive({efforts[0], efforts[1]}, dt);
    // A difference of speeds of order 1 over 1 ms: rounding of 10⁻¹⁶/10⁻³.
    EXPECT_NEAR((plant.twist.linear - before.linear) / dt, acceleration.linear, 1e-11) << "seed " << seed;
    EXPECT_NEAR((plant.twist.angular - before.angular) / dt, acceleration.angular, 1e-11) << "seed " << seed;
  }
}

}  // namespace robot_control::tests
