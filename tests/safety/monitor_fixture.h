#pragma once
/// A healthy robot around a SafetyMonitor: every cycle there are sensors, a state and a command.

#include <gtest/gtest.h>

#include "safety/safety_monitor.h"

namespace robot_control {

/// Healthy case: standing in READY at cycle 20, nothing asked for. Heartbeat timeout 50 ms, ramp at most 100 ms.
class MonitorTest : public testing::Test {
 protected:
  static constexpr double kPeriod = 1e-3;
  static constexpr std::size_t kWheels = 2;
  static constexpr std::uint64_t kLoss = 20;
  static constexpr std::uint64_t kHeartbeat = 50;
  static constexpr std::uint64_t kRamp = 100;

  MonitorTest() {
    sensors_.head.run = 1;
    sensors_.boot = 77;
    sensors_.driver_state = DriverState::kRunning;
    sensors_.valid = kValidJoints | kValidGyro | kValidAccelerometer;
    sensors_.joint_count = command_.joint_count = kWheels;
    input_.sensors = &sensors_;
    input_.command = &command_;
    input_.state_seen = true;
    while (sensors_.head.cycle < 20) step();
  }

  static SafetyParameters parameters() {
    SafetyParameters parameters;
    parameters.loss_cycles = kLoss;
    parameters.heartbeat_timeout = static_cast<double>(kHeartbeat) * kPeriod;
    parameters.ramp_time = static_cast<double>(kRamp) * kPeriod;
    return parameters;
  }

  /// Two wheels of 0.1 m radius, 0.5 m apart.
  static RobotModel robot() {
    RobotModel robot;
    robot.joints.assign(kWheels, {.name = "wheel", .child_link = "wheel", .effort_limit = 3, .velocity_limit = 20});
    robot.wheels = {{.joint = 0, .centre_base = {0, 0.25, 0}, .radius = 0.1, .width = 0.04, .inertia = 0.005},
                    {.joint = 1, .centre_base = {0, -0.25, 0}, .radius = 0.1, .width = 0.04, .inertia = 0.005}};
    robot.wheels[1].side = Side::kRight;
    robot.wheel_base = 0.5;
    robot.mass = 12;
    return robot;
  }

  /// The next cycle.
  void step() {
    if (begun_) ++sensors_.head.cycle;
    begun_ = true;
    monitor_.step(input_, permit_);
  }
  void steps(std::uint64_t cycles) {
    for (std::uint64_t i = 0; i < cycles; ++i) step();
  }
  void new_run() {
    ++sensors_.head.run;
    sensors_.head.cycle = 0;
    begun_ = false;
    monitor_.reset(input_.operator_input);
  }
  void ask_for(double linear) { command_.twist_requested.linear[0] = linear; }
  void turn_wheels(double speed) { sensors_.joints[0].velocity = sensors_.joints[1].velocity = speed; }
  void drive() {
    ask_for(0.5);
    turn_wheels(5);
    steps(5);
    ASSERT_EQ(permit_.state, SupervisorState::kDrive);
  }
  /// Standing long enough to be believed.
  void stand() {
    ask_for(0);
    turn_wheels(0);
    steps(JointStandstill::kStandingCycles);
  }
  void request_reset() { ++input_.operator_input.resets; }
  /// A reset request, handled in the next cycle.
  std::uint64_t reset() {
    request_reset();
    step();
    EXPECT_EQ(permit_.resets_handled, input_.operator_input.resets);
    return permit_.reset_refusal;
  }
  std::uint64_t cycle() const { return sensors_.head.cycle; }

  SensorFrame sensors_;
  CommandFrame command_;
  MonitorInput input_;
  SafetyMonitor monitor_{parameters(), robot(), kPeriod};
  Permit permit_;
  bool begun_ = false;
};

}  // namespace robot_control
