#include "drivers/mujoco/model/true_robot.h"

#include <gtest/gtest.h>

#include "drivers/mujoco/constants.h"
#include "support/robots/diffbot_urdf.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

struct TrueRobotTest : testing::Test {
  TrueRobotTest() { parameters_.sensor_errors = ErrorLevel::kDataSheet; }

  TrueRobot real() const { return true_robot(believed_, parameters_, kStep); }

  DriveTrain believed_ = read_drive_train(diffbot_urdf(), {});
  MujocoPlantParameters parameters_;
};

TEST_F(TrueRobotTest, IsTheUrdfWhereNothingErrs) {
  const TrueRobot robot = real();
  EXPECT_EQ(robot.wheels[0].shape.radius, 0.1);
  EXPECT_EQ(robot.wheels[0].shape.centre_base[1] - robot.wheels[1].shape.centre_base[1], 0.5);
  EXPECT_NEAR(robot.mass, 12, 1e-12);
}

TEST_F(TrueRobotTest, IgnoresTheNominalValues) {
  DriveTrainParameters parameters;
  parameters.wheel_radius = 0.2;
  parameters.wheel_base = 0.9;
  parameters.mass = 40;
  parameters.imu_position = Vector3{1, 2, 3};
  parameters.imu_orientation = Vector3{0, 0, 1};
  believed_ = read_drive_train(diffbot_urdf(), parameters);
  const TrueRobot robot = real();
  EXPECT_EQ(robot.imu_in_base.position, (Vector3{0.05, 0.02, 0.06}));
  EXPECT_EQ(robot.imu_in_base.orientation, (Quaternion{0, 0, 0, 1}));
  EXPECT_EQ(robot.wheels[0].shape.radius, 0.1);
  EXPECT_EQ(robot.wheels[0].shape.centre_base[1] - robot.wheels[1].shape.centre_base[1], 0.5);
  EXPECT_NEAR(robot.mass, 12, 1e-12);
}

TEST_F(TrueRobotTest, HasTheDrivesOfTheUser) {
  DriveTrainParameters parameters;
  parameters.wheel_effort_limit = 1.25;
  believed_ = read_drive_train(diffbot_urdf(), parameters);
  EXPECT_EQ(real().joints[0].effort_limit, 1.25);
}

TEST_F(TrueRobotTest, RadiiErrBySide) {
  parameters_.left_radius_error = 0.01;
  parameters_.right_radius_error = -0.02;
  EXPECT_NEAR(real().wheels[0].shape.radius, 0.101, 1e-12);
  EXPECT_NEAR(real().wheels[1].shape.radius, 0.098, 1e-12);
}

TEST_F(TrueRobotTest, AWiderWheelBaseMovesTheWheelsOutwards) {
  parameters_.wheel_base_error = 0.02;
  const TrueRobot robot = real();
  EXPECT_NEAR(robot.wheels[0].shape.centre_base[1], 0.255, 1e-12);
  EXPECT_NEAR(robot.wheels[1].shape.centre_base[1], -0.255, 1e-12);
  EXPECT_NEAR(robot.bodies->moved_by("left_wheel_joint")->in_root.translation().y(), 0.255, 1e-12);
}

TEST_F(TrueRobotTest, TheJointsFrictionErrs) {
  auto [text, source] = MadeRobot{}.description();
  const std::string end = "velocity=\"100\"/>";
  for (std::size_t at = text.find(end); at != std::string::npos; at = text.find(end, at + end.size())) {
    text.insert(at + end.size(), "<dynamics friction=\"0.4\"/>");
  }
  believed_ = read_drive_train({text, source}, MadeRobot{}.names());
  parameters_.wheel_friction_error = 2;
  EXPECT_NEAR(real().joints[0].friction, 1.2, 1e-12);
  EXPECT_NEAR(real().bodies->moved_by("right_0")->joint.friction, 1.2, 1e-12);
}

TEST_F(TrueRobotTest, TheRotorTurnsWithTheSquareOfTheGear) {
  parameters_.gear_ratio = 10;
  parameters_.rotor_inertia = 2e-5;
  EXPECT_NEAR(real().wheels[0].inertia, believed_.wheels[0].inertia + 2e-3, 1e-12);
  EXPECT_NEAR(real().wheels[0].rotor_inertia, believed_.wheels[0].rotor_inertia + 2e-3, 1e-12);
}

// The parallel axes of two point masses add m₁ m₂ / (m₁ + m₂) d².
TEST_F(TrueRobotTest, APayloadIsAPointMassOnTheBase) {
  believed_ = MadeRobot{}.model();
  parameters_.payload = 5;
  parameters_.payload_z = 0.3;
  const TrueRobot robot = real();
  EXPECT_NEAR(robot.mass, believed_.mass + 5, 1e-12);
  const RigidBody& loaded = robot.bodies->bodies[0];
  const RigidBody& empty = believed_.bodies->bodies[0];
  EXPECT_NEAR(loaded.centre_of_gravity.z(), 0.1, 1e-12);
  EXPECT_NEAR(loaded.inertia(0, 0) - empty.inertia(0, 0), 10.0 * 5 / 15 * 0.09, 1e-12);
  EXPECT_NEAR(loaded.inertia(2, 2), empty.inertia(2, 2), 1e-12);
}

}  // namespace robot_control::tests
