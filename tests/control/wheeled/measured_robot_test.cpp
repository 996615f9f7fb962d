#include "control/wheeled/measured_robot.h"

#include <gtest/gtest.h>

#include "control/wheeled/control_bench.h"
#include "control/wheeled/control_problems.h"

namespace robot_control::tests {

TEST(MeasuredRobot, IsTheUrdfsWhereNothingWasMeasured) {
  DriveTrain robot = make_test_robot();
  robot.hash = 7;
  robot.joints[0].damping = 0.1;
  robot.joints[1].friction = 0.2;
  const DriveTrain same = measured_robot(robot, {});
  EXPECT_EQ(same.mass, robot.mass);
  EXPECT_EQ(same.yaw_inertia, robot.yaw_inertia);
  EXPECT_EQ(same.wheels[1].inertia, robot.wheels[1].inertia);
  EXPECT_EQ(same.joints[0].damping, 0.1);
  EXPECT_EQ(same.joints[1].friction, 0.2);
  EXPECT_EQ(same.hash, 7u);
}

TEST(MeasuredRobot, TakesWhatWasMeasuredForEveryWheelAlike) {
  const DriveTrain measured = measured_robot(
      make_skid_steer(),
      {.mass = 30, .yaw_inertia = 0.8, .wheel_inertia = 0.01, .wheel_damping = 0.03, .wheel_friction = 0.4});
  EXPECT_EQ(measured.mass, 30);
  EXPECT_EQ(measured.yaw_inertia, 0.8);
  for (const WheelModel& wheel : measured.wheels) {
    EXPECT_EQ(wheel.inertia, 0.01);
    EXPECT_EQ(measured.joints[wheel.joint].damping, 0.03);
    EXPECT_EQ(measured.joints[wheel.joint].friction, 0.4);
  }
}

TEST(MeasuredRobot, IsWhatTheStabilityCheckJudges) {
  // kp·dt/(2·J) = 4·10⁻³/(2·J) reaches 1 at J = 0.002 (wheel_loop_stability.h).
  DriveControllerParameters parameters;
  parameters.pid_kp = 4;
  parameters.pid_ki = 20;
  EXPECT_TRUE(control_problems(parameters, make_test_robot(), 1e-3).empty());
  parameters.feed_forward.wheel_inertia = 0.0015;
  EXPECT_FALSE(control_problems(parameters, make_test_robot(), 1e-3).empty());
}

/// N·m: the torque of the cycle in which a ramp of 1 m/s² begins, feed-forward alone.
double first_torque(const FeedForwardParameters& measured) {
  DriveControllerParameters parameters = straight_ramps();
  parameters.pid_kp = 0;
  parameters.pid_ki = 0;
  parameters.feed_forward = measured;
  ControlBench bench(make_test_robot(), parameters);
  for (int cycle = 0; cycle < 100 && bench.command.joints[0].effort == 0; ++cycle) {
    bench.send(1, 0);
    bench.step();
  }
  return bench.command.joints[0].effort;
}

TEST(MeasuredRobot, IsWhatTheFeedForwardDrives) {
  EXPECT_NEAR(first_torque({}), 0.65, 1e-12);  // 0.065 kg·m² · 10 rad/s²
  EXPECT_NEAR(
      first_torque({.mass = 24, .yaw_inertia = {}, .wheel_inertia = {}, .wheel_damping = {}, .wheel_friction = {}}),
      1.25, 1e-12);
}

}  // namespace robot_control::tests
