#include "drivers/mujoco/motors/brake_limits.h"

#include "drivers/driver.h"
#include "drivers/mujoco/constants.h"
#include "machine/wheeled/tipping.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

// Centre of gravity 0.2 m above the ground, axles 0.15 m before and behind it.
MadeRobot four_wheels() {
  MadeRobot robot;
  robot.axles = {0.15, -0.15};
  robot.body_mass = 16;
  robot.body_z = 0.125;  // 16 kg at 0.225 m, 4 kg at 0.1 m
  return robot;
}

/// Returns the brake of the first wheel of this robot.
Brake wheel_brake_of(const DriveTrain& robot, MujocoPlantParameters parameters = {}) {
  parameters.sensor_errors = ErrorLevel::kIdeal;
  return brake_of(true_robot(robot, parameters, kStep), 0, parameters, kStep);
}

TEST(LiftingDeceleration, IsTheLeverOfTheWeightOverThatOfTheInertia) {
  EXPECT_NEAR(lifting_deceleration(four_wheels().model()), kEarthGravity * 0.15 / 0.2, 1e-9);
}

TEST(LiftingDeceleration, CountsABallBehindTheAxleAsASupport) {
  MadeRobot robot;
  robot.body_x = -0.12;  // 10 of 12 kg: centre of gravity at −0.1 m
  robot.ball_x = -0.3;
  EXPECT_NEAR(lifting_deceleration(robot.model()), kEarthGravity * 0.1 / 0.1, 1e-9);
}

TEST(BrakeOf, LeavesToTheMotorsFrictionWhatThatBrakes) {
  MujocoPlantParameters parameters;
  parameters.gear_ratio = 10;
  parameters.motor_friction = 0.02;
  const DriveTrain robot = four_wheels().model();
  EXPECT_NEAR(wheel_brake_of(robot, parameters).effort, wheel_brake_of(robot).effort - 0.2, 1e-9);
}

TEST(BrakeOf, TakesWhatTheUserSays) {
  MujocoPlantParameters parameters;
  parameters.brake_effort = 1.5;
  parameters.brake_damping = 1;
  parameters.brake_stiffness = 100;
  parameters.brake_hold_speed = 0.2;
  const Brake brake = wheel_brake_of(four_wheels().model(), parameters);
  EXPECT_EQ(brake.effort, 1.5);
  EXPECT_EQ(brake.hold_effort, 1.5);
  EXPECT_EQ(brake.damping, 1);
  EXPECT_EQ(brake.stiffness, 100);
  EXPECT_EQ(brake.hold_speed, 0.2);
}

struct CheckBrake : testing::Test {
  std::string refusal() const {
    return message_of<DriverError>([&] { check_brake(brake_, "left_wheel_joint", 0.005, kStep); }, "accepted");
  }
  Brake brake_{.effort = 3, .damping = 2, .stiffness = 300, .hold_speed = 0.3};
};

TEST_F(CheckBrake, AcceptsWhatALightWheelBears) {
  EXPECT_EQ(refusal(), "accepted");
}

TEST_F(CheckBrake, RefusesDampingThatALightWheelDoesNotBear) {
  brake_.damping = 2.6;  // 2.6 · 0.001 / 0.005 = 0.52
  EXPECT_THAT(refusal(), HasSubstr("brake_damping"));
}

TEST_F(CheckBrake, RefusesStiffnessThatALightWheelDoesNotBear) {
  brake_.stiffness = 2600;  // 2600 · 10⁻⁶ / 0.005 = 0.52
  EXPECT_THAT(refusal(), HasSubstr("brake_stiffness"));
}

TEST(CheckBrakeOfATinyWheel, NamesItsNumbers) {
  const std::string message = message_of<DriverError>(
      [&] { check_brake({.effort = 1, .damping = 1, .stiffness = 1, .hold_speed = 1}, "tiny", 4e-7, kStep); });
  EXPECT_THAT(message, AllOf(HasSubstr("4e-07 kg·m²"), HasSubstr("up to 0.0002 ")));
}

TEST_F(CheckBrake, RefusesABrakeThatDoesNotHold) {
  brake_.stiffness = 0;
  EXPECT_THAT(refusal(), HasSubstr("brake_stiffness"));
}

}  // namespace robot_control::tests
