/// A simulated drive with a speed loop of its own, on a wheel that carries a load.

#include "drivers/mujoco/motors/velocity_drive.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr double kStep = 0.001;     // s
constexpr double kInertia = 0.065;  // kg·m²

struct VelocityDriveTest : testing::Test {
  VelocityDriveParameters parameters{
      .loaded_inertia = kInertia,
      .lifted_inertia = 0.005,
      .effort_limit = 5,
      .brake = {.effort = 2, .hold_effort = 3, .damping = 1, .stiffness = 1, .hold_speed = 0.3}};
  double velocity = 0;
  double effort = 0;

  void run(const JointCommand& command, double seconds, double load = 0) {
    VelocityDrive drive(parameters, kStep);
    for (double t = 0; t < seconds; t += kStep) {
      effort = drive.step(command, velocity);
      velocity += (effort - load) / kInertia * kStep;
    }
  }
  static JointCommand at(double speed) { return {.mode = JointMode::kDriveVelocity, .velocity = speed}; }
};

TEST_F(VelocityDriveTest, ReachesItsSpeedWhateverTheLoad) {
  run(at(3), 2, 1);
  EXPECT_NEAR(velocity, 3, 1e-3);
  EXPECT_NEAR(effort, 1, 1e-2);
}

TEST_F(VelocityDriveTest, AddsTheTorqueOfTheCommandIfItTakesOne) {
  const JointCommand ahead{.mode = JointMode::kDriveVelocity, .velocity = 0, .effort = 1};
  run(ahead, kStep);
  EXPECT_EQ(effort, 1);
  velocity = 0;
  parameters.takes_feed_forward = false;
  run(ahead, kStep);
  EXPECT_EQ(effort, 0);
}

/// As a slope that is too steep for the effort of the brake does.
TEST_F(VelocityDriveTest, HoldsALoadThatItsBrakingEffortDoesNotSlowDown) {
  constexpr double kSteep = 2.5;  // N·m, between effort and hold_effort
  for (const double begin : {0.0, -5.0}) {
    velocity = begin;
    run({}, 8, kSteep);
    EXPECT_NEAR(velocity, 0, 1e-3) << begin;
    EXPECT_NEAR(effort, kSteep, 1e-2) << begin;
  }
}

TEST_F(VelocityDriveTest, GivesNoMoreThanItsTorque) {
  run(at(1000), 0.1);
  EXPECT_EQ(effort, parameters.effort_limit);
}

TEST_F(VelocityDriveTest, TakesSlowCommandsAsZeroAndOthersInSteps) {
  parameters.dead_band = 0.5;
  parameters.resolution = 0.4;
  run(at(0.55), 2);
  EXPECT_NEAR(velocity, 0, 1e-6);
  run(at(1.1), 2);
  EXPECT_NEAR(velocity, 1.2, 1e-3);
}

TEST_F(VelocityDriveTest, BrakesWithTheTorqueOfItsBrakeAndThenHoldsALoad) {
  velocity = 10;
  run({}, kStep);
  EXPECT_EQ(effort, -parameters.brake.effort);
  run({}, 3, 1);
  EXPECT_NEAR(velocity, 0, 1e-3);
  EXPECT_NEAR(effort, 1, 1e-2);
}

TEST_F(VelocityDriveTest, OneThatReleasesGivesNoTorqueOnceItStood) {
  parameters.at_rest = DriveBrake::kRelease;
  velocity = 1;
  run({}, 3, 0.1);
  EXPECT_EQ(effort, 0);
  EXPECT_LT(velocity, -1) << "the load moves it";
}

TEST_F(VelocityDriveTest, TorquesAndNumbersThatAreNotFiniteBrake) {
  for (const JointCommand& command :
       {JointCommand{.mode = JointMode::kEffort, .effort = 4}, at(std::numeric_limits<double>::quiet_NaN())}) {
    velocity = 5;
    run(command, 2);
    EXPECT_NEAR(velocity, 0, 1e-3);
  }
}

}  // namespace robot_control::tests
