/// The brakes and stop actions of wheels, by the numbers of their header.

#include "gate/wheeled/wheel_stop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/robots/made_robot.h"

namespace robot_control::tests {

constexpr double kEarthGravity = 9.81;  // m/s²
constexpr double kStep = 0.001;         // s
const double kSin5 = std::sin(5 * M_PI / 180);
const double kSin10 = std::sin(10 * M_PI / 180);

// 20 kg. Centre of gravity 0.2 m above the ground, axles 0.15 m before and behind it: wheels lift at 0.75 g.
MadeRobot four_wheels() {
  MadeRobot robot;
  robot.axles = {0.15, -0.15};
  robot.body_mass = 16;
  robot.body_z = 0.125;  // 16 kg at 0.225 m, 4 kg at 0.1 m
  return robot;
}

// A wheel of 1 kg and 0.1 m has 0.5 kg of inertia at its rim.
constexpr double kMoved = 20 + 4 * 0.5;  // kg

Brake brake_of(const DriveTrain& robot, double motor_friction = 0) {
  return wheel_brake(robot, 0, motor_friction, kStep);
}

/// N·m of one of four wheels.
double torque_of(double force) {
  return force * 0.1 / 4;
}

TEST(WheelBrake, BrakesWithHalfTheLiftingDeceleration) {
  const Brake brake = brake_of(four_wheels().model());
  EXPECT_NEAR(brake.effort, torque_of(kMoved * 0.5 * kEarthGravity * 0.75), 1e-9);
  EXPECT_EQ(brake.hold_effort, brake.effort);
}

TEST(WheelBrake, HoldsATopHeavyRobotOnASlopeOfTenDegrees) {
  MadeRobot robot = four_wheels();
  robot.body_z = 3;
  EXPECT_NEAR(brake_of(robot.model()).hold_effort, torque_of(20 * kEarthGravity * kSin10), 1e-9);
}

// Half of the lifting force is less than the slope takes; all of it is not.
TEST(WheelBrake, SlowsATopHeavyRobotAlmostUntilItTips) {
  MadeRobot robot = four_wheels();
  robot.body_z = 1.0;  // centre of gravity at (16 · 1.1 + 4 · 0.1)/20 = 0.9 m, lifts at g/6
  const Brake brake = brake_of(robot.model());
  EXPECT_NEAR(brake.effort, torque_of(kMoved * 0.9 * kEarthGravity / 6), 1e-9);
  EXPECT_GT(brake.hold_effort, brake.effort);
}

// Centre of gravity at 0.7 m, lifts at 0.21 g: 0.9 of that force is more than the slope takes, half of it is less.
TEST(WheelBrake, SlowsOnASlopeOfTenDegreesWhereThatTipsNothing) {
  MadeRobot robot = four_wheels();
  robot.body_z = 0.75;
  EXPECT_NEAR(brake_of(robot.model()).effort, torque_of(20 * kEarthGravity * kSin10), 1e-9);
}

// The centre of gravity right above the only axle has no lever.
TEST(WheelBrake, SlowsOnASlopeOfFiveDegreesWhateverTips) {
  const Brake brake = brake_of(MadeRobot{}.model());
  EXPECT_NEAR(brake.effort, 12 * kEarthGravity * kSin5 * 0.1 / 2, 1e-9);
  EXPECT_NEAR(brake.hold_effort, 12 * kEarthGravity * kSin10 * 0.1 / 2, 1e-9);
}

TEST(WheelBrake, LeavesToTheFrictionOfJointAndMotorWhatThatBrakes) {
  DriveTrain robot = four_wheels().model();
  const Brake whole = brake_of(robot);
  robot.joints[0].friction = 0.15;
  EXPECT_NEAR(brake_of(robot, 0.05).effort, whole.effort - 0.2, 1e-9);
  EXPECT_NEAR(brake_of(robot, 0.05).hold_effort, whole.hold_effort - 0.2, 1e-9);
}

TEST(WheelBrake, BrakesWithATenthWhereFrictionDoesMost) {
  DriveTrain robot = four_wheels().model();
  const Brake whole = brake_of(robot);
  robot.joints[0].friction = 50;
  EXPECT_NEAR(brake_of(robot).effort, whole.effort / 10, 1e-9);
}

TEST(WheelBrake, IsNeverStrongerThanTheDrive) {
  MadeRobot robot = four_wheels();
  robot.effort = 0.7;
  EXPECT_EQ(brake_of(robot.model()).effort, 0.7);
  EXPECT_EQ(brake_of(robot.model()).hold_effort, 0.7);
}

// A wheel of 0.005 kg·m² and 0.1 m: 0.4 J/h, 0.06 J/h², 0.03 m/s at the rim.
TEST(WheelBrake, DampsAndHoldsFourTimesBelowTheStabilityLimits) {
  const Brake brake = brake_of(four_wheels().model());
  EXPECT_NEAR(brake.damping, 2, 1e-9);
  EXPECT_NEAR(brake.stiffness, 300, 1e-6);
  EXPECT_NEAR(brake.hold_speed, 0.3, 1e-12);
  const Brake slower = wheel_brake(four_wheels().model(), 0, 0, 2 * kStep);
  EXPECT_NEAR(slower.damping, 1, 1e-9);
  EXPECT_NEAR(slower.stiffness, 75, 1e-6);
}

// 0.3 J/period.
TEST(BrakesOfSlowDrives, DampHalfOfWhatIsStableOnSamplesTwoPeriodsOld) {
  const std::vector<Brake> brakes = brakes_of_slow_drives(four_wheels().model(), 0.002);
  ASSERT_EQ(brakes.size(), 4u);
  for (const Brake& brake : brakes) EXPECT_NEAR(brake.damping, 0.3 * 0.005 / 0.002, 1e-9);
  EXPECT_EQ(brakes[3].effort, brake_of(four_wheels().model()).effort);
}

// The forces Σ d v/r² of all wheels give the mass 2 m/s² at 1 m/s, which is 63 % of the speed in 0.5 s.
TEST(WheelStop, OfADampedRobotTakesItsSpeedInHalfASecond) {
  const DriveTrain robot = four_wheels().model();
  double force = 0;
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    const StopAction stop = wheel_stop(robot, i, StopKind::kDamp);
    EXPECT_EQ(stop.kind, StopKind::kDamp);
    force += stop.damping / (0.1 * 0.1);
  }
  EXPECT_NEAR(force, 2 * robot.mass, 1e-9);
}

}  // namespace robot_control::tests
