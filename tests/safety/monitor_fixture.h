#pragma once
/// A healthy robot around a SafetyMonitor: every cycle there are sensors, a state and a command, and a gate that does
/// what the permits say.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "safety/derived_limits.h"
#include "safety/safety_monitor.h"

namespace robot_control {

/// Healthy case: standing in READY at cycle kStart, nothing asked for, encoders of 4096 counts. Heartbeat timeout 0.3
/// s, ramp at most 0.3 s. Two wheels of 0.1 m radius, 0.5 m apart, of at most 15 rad/s.
class MonitorTest : public testing::Test {
 protected:
  static constexpr double kPeriod = 1e-3;
  static constexpr std::size_t kWheels = 2;
  static constexpr std::uint64_t kLoss = 20;
  static constexpr std::uint64_t kHeartbeat = 300;
  static constexpr std::uint64_t kRamp = 300;
  static constexpr std::uint64_t kStands = 102;  ///< cycles until it is believed: kStandingTime, the anchor, the count
  static constexpr std::uint64_t kStart = 120;
  static constexpr double kQuantum = 2 * std::numbers::pi / 4096;
  static constexpr double kSpeed = 5;  ///< rad/s, when it drives

  MonitorTest() {
    sensors_.head.run = 1;
    sensors_.boot = 77;
    sensors_.driver_state = DriverState::kRunning;
    sensors_.valid = kValidJoints | kValidGyro | kValidAccelerometer;
    sensors_.imu.linear_acceleration = {0, 0, 9.81};
    sensors_.joint_count = command_.joint_count = kWheels;
    input_.sensors = &sensors_;
    input_.command = &command_;
    input_.state_seen = true;
    while (sensors_.head.cycle < kStart) step();
  }

  static SafetyParameters parameters() {
    SafetyParameters parameters;
    parameters.loss_cycles = kLoss;
    parameters.heartbeat_timeout = static_cast<double>(kHeartbeat) * kPeriod;
    parameters.ramp_time = static_cast<double>(kRamp) * kPeriod;
    return derived_limits(parameters, robot(), 15);
  }

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
    const std::uint64_t elapsed = begun_ ? 1 + skip_ : 0;
    sensors_.head.cycle += elapsed;
    begun_ = true;
    skip_ = 0;
    const std::uint64_t cycle = sensors_.head.cycle;
    for (std::size_t i = 0; i < kWheels; ++i) {
      angle_[i] += speed_[i] * static_cast<double>(elapsed) * kPeriod;
      sensors_.joints[i].position = kQuantum * std::floor(angle_[i] / kQuantum);
      sensors_.joints[i].velocity = speed_[i];
    }
    if (noisy_gyro_) sensors_.imu.angular_velocity[0] = cycle % 2 == 0 ? 1e-4 : -1e-4;
    if (noisy_gyro_) sensors_.imu.linear_acceleration[0] = cycle % 2 == 0 ? 1e-3 : -1e-3;
    command_.head.cycle = cycle == 0 ? 0 : cycle - 1;
    if (fresh_state_) command_.state_cycle = command_.head.cycle;
    run_gate(cycle);
    monitor_.step(input_, permit_);
    given_[1] = given_[0];
    given_[0] = {true, cycle, permit_.action, permit_.ramp_until};
  }
  void steps(std::uint64_t cycles) {
    for (std::uint64_t i = 0; i < cycles; ++i) step();
  }
  /// The monitor does not look at the next `cycles` ones.
  void skip(std::uint64_t cycles) { skip_ = cycles; }
  void new_run() {
    ++sensors_.head.run;
    sensors_.head.cycle = 0;
    begun_ = false;
    given_ = {};
    monitor_.reset(input_.operator_input);
  }
  /// `linear` m/s wished, and the wheels' targets; 0: the brake holds.
  void ask_for(double linear) {
    command_.twist_requested.linear[0] = linear;
    target(linear == 0 ? 0 : kSpeed);
  }
  void target(double speed) {
    for (std::size_t i = 0; i < kWheels; ++i) {
      command_.joints[i] = {.mode = speed == 0 ? JointMode::kBrake : JointMode::kEffort, .velocity = speed};
    }
  }
  void turn_wheels(double speed) { speed_ = {speed, speed}; }
  void drive() {
    ask_for(0.5);
    turn_wheels(kSpeed);
    steps(5);
    ASSERT_EQ(permit_.state, SupervisorState::kDrive);
  }
  /// Standing long enough to be believed.
  void stand() {
    ask_for(0);
    turn_wheels(0);
    steps(kStands);
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
  bool gate_passes() const { return sensors_.gate.verdict != GateVerdict::kBrake; }

  SensorFrame sensors_;
  CommandFrame command_;
  MonitorInput input_;
  SafetyMonitor monitor_{parameters(), robot(), kPeriod};
  Permit permit_;
  bool begun_ = false;
  bool noisy_gyro_ = true;
  bool fresh_state_ = true;              ///< the command descends from the state of its own cycle
  bool gate_obeys_ = true;               ///< false: it lets everything pass
  bool gate_works_ = true;               ///< false: it brakes always
  std::array<double, kWheels> speed_{};  ///< rad/s, true

 private:
  struct Given {
    bool there = false;
    std::uint64_t cycle = 0;
    PermitAction action = PermitAction::kBrake;
    std::uint64_t ramp_until = 0;
  };

  /// Tick k−1, reported in the sensors of cycle k.
  void run_gate(std::uint64_t cycle) {
    GateReport& report = sensors_.gate;
    report = {};
    if (cycle < 2) return;
    const std::uint64_t tick = cycle - 1;
    const Given& used = given_[0].cycle < tick ? given_[0] : given_[1];
    without_command_ = input_.command == nullptr ? without_command_ + 1 : 0;
    const bool driven =
        used.action == PermitAction::kDrive || (used.action == PermitAction::kRamp && tick <= used.ramp_until);
    const bool allowed = used.there && tick - used.cycle <= kPermitLife && driven;
    report.permit_cycle = used.cycle;
    report.reasons = 0;
    if (command_.joints[0].mode == JointMode::kBrake) report.reasons |= kGateControllerBrake;
    if (without_command_ >= kCommandLife) report.reasons |= kGateNoCommand;
    if (!allowed && gate_obeys_) report.reasons |= kGatePermitBrake;
    if (report.reasons == 0 && gate_works_) report.verdict = GateVerdict::kPassed;
  }

  std::uint64_t skip_ = 0;
  std::uint64_t without_command_ = 0;
  std::array<double, kWheels> angle_{};
  std::array<Given, 2> given_{};
};

}  // namespace robot_control
