#include "estimation/legged/legged_estimator.h"

#include "machine/gravity.h"
#include "machine/legs/legs_corpus.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

/// quadbot, which stands at rest on four feet with force sensors.
struct Standing {
  static constexpr double kPeriod = 0.001;  // s
  LegModel robot = legged_robot("quadbot");
  LeggedEstimator estimator{robot, kPeriod};
  SensorFrame sensors;
  StateFrame out;

  Standing() {
    sensors.valid = kValidGyro | kValidAccelerometer;
    sensors.imu.linear_acceleration = {0, 0, kGravity};
    sensors.joint_count = kLegsJoints;
    sensors.contact_count = kLegs;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      sensors.contacts[leg] = {.force = {0, 0, 31}, .valid = 1};
      sensors.gate.contact_schedule[leg] = 0.5;
      for (std::size_t i = 0; i < kLegJoints; ++i) {
        JointSample& joint = sensors.joints[kLegJoints * leg + i];
        joint.valid = kValidMotion;
        joint.position = i == 1 ? 0.8 : i == 2 ? -1.6 : 0;
      }
    }
  }
  void run(double seconds) {
    for (double time = 0; time < seconds - kPeriod / 2; time += kPeriod) {
      ++sensors.head.cycle;
      estimator.step(sensors, out);
    }
  }
  double speed() const { return std::hypot(out.base.twist_base.linear[0], out.base.twist_base.linear[1]); }
};

TEST(LeggedEstimator, LearnsTheGyrosBiasAtRest) {
  Standing robot;
  robot.sensors.imu.angular_velocity = {0.03, -0.02, 0.04};
  robot.run(3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(robot.out.base.gyro_bias[i], robot.sensors.imu.angular_velocity[i], 5e-4) << i;
    EXPECT_LE(robot.out.base.gyro_bias_deviation[i], 1e-3) << i;
  }
  EXPECT_LE(robot.speed(), 1e-3);
  EXPECT_EQ(robot.out.base.degraded, 0u);
}

// The filter knows the place of the IMU, the pose that of the base.
TEST(LeggedEstimator, BeginsAtZeroWhereverTheImuIs) {
  Standing robot;
  robot.robot.imu_in_base.position = {0.25, -0.1, 0.05};
  robot.estimator = LeggedEstimator(robot.robot, Standing::kPeriod);
  robot.run(0.001);
  for (const double coordinate : robot.out.base.pose_odom.position) EXPECT_NEAR(coordinate, 0, 1e-6);
}

// Joints that are not valid keep their last angles, at which the feet would seem to hold the robot where it is.
TEST(LeggedEstimator, LetsTheDeviationsGrowWithoutTheJoints) {
  Standing robot;
  robot.run(1);
  const double place = robot.out.base.pose_covariance[0];
  for (std::size_t i = 0; i < kLegsJoints; ++i) robot.sensors.joints[i].valid = 0;
  double before = robot.out.base.twist_covariance[0];
  for (int i = 0; i < 20; ++i) {
    robot.run(0.1);
    EXPECT_GT(robot.out.base.twist_covariance[0], before) << i;
    before = robot.out.base.twist_covariance[0];
  }
  EXPECT_GT(robot.out.base.pose_covariance[0], place + 1e-3);
}

TEST(LeggedEstimator, GivesWayToThePlainEstimateWhereTheyContradict) {
  Standing robot;
  robot.run(1);
  // An accelerometer that fails pushes the filter away from four feet that stand.
  robot.sensors.imu.linear_acceleration[0] = 60;
  double fastest = 0;
  bool degraded = false;
  for (int k = 0; k < 500; ++k) {
    robot.sensors.joints[1].velocity = 0.1;  // it is not at rest
    robot.run(Standing::kPeriod);
    fastest = std::max(fastest, robot.speed());
    degraded = degraded || (robot.out.base.flags & kStateDegraded) != 0;
  }
  EXPECT_TRUE(degraded);
  EXPECT_NE(robot.out.base.degraded & kDegradedPosition, 0u);
  EXPECT_LE(fastest, 60 * 0.15);
}

/// One foot stands, and three land with the speed of a swing.
TEST(LeggedEstimator, TakesNoFootForALandmarkThatBearsButStillMoves) {
  Standing robot;
  robot.sensors.gate.contact_schedule = {0, 0, 0, 0.5};
  for (std::size_t leg = 0; leg < 3; ++leg) robot.sensors.contacts[leg].force = {};
  robot.run(1);
  const Vector3 before = robot.out.base.pose_odom.position;
  robot.sensors.gate.contact_schedule = {0.1, 0.1, 0.1, 0.5};
  for (std::size_t leg = 0; leg < 3; ++leg) robot.sensors.contacts[leg].force = {0, 0, 31};
  for (int k = 0; k < 30; ++k) {
    for (std::size_t leg = 0; leg < 3; ++leg) {
      robot.sensors.joints[3 * leg + 2].velocity = -4;  // its foot moves with 0.7 m/s
      robot.sensors.joints[3 * leg + 2].position -= 4 * Standing::kPeriod;
    }
    robot.run(Standing::kPeriod);
    EXPECT_LE(robot.speed(), 0.01) << k;
  }
  for (std::size_t leg = 0; leg < 3; ++leg) robot.sensors.joints[3 * leg + 2].velocity = 0;
  robot.run(0.1);
  for (std::size_t leg = 0; leg < kLegs; ++leg) EXPECT_EQ(robot.estimator.state().stands[leg], 1u) << leg;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(robot.out.base.pose_odom.position[i], before[i], 1e-3) << i;
}

TEST(LeggedEstimator, ContinuesWithoutAJump) {
  Standing robot;
  robot.sensors.imu.angular_velocity = {0.03, -0.02, 0.04};
  robot.run(3);
  robot.estimator.set_pose({2, 1, 0.5});
  robot.run(0.01);
  const StateFrame before = robot.out;
  EXPECT_NEAR(before.base.pose_odom.position[0], 2, 1e-6);
  EXPECT_LE(before.base.pose_covariance[0], 1e-8);
  LeggedEstimator restarted(robot.robot, Standing::kPeriod);
  restarted.resume(before);
  ++robot.sensors.head.cycle;
  restarted.step(robot.sensors, robot.out);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(robot.out.base.pose_odom.position[i], before.base.pose_odom.position[i], 1e-4) << i;
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(robot.out.base.twist_base.linear[i], before.base.twist_base.linear[i], 1e-3) << i;
}

TEST(LeggedEstimator, AllocatesNothing) {
  Standing robot;
  const AllocationGuard guard;
  robot.run(0.01);
  robot.estimator.set_pose({1, 0, 0});
  robot.run(0.01);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests
