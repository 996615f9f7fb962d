#pragma once
/// A healthy robot around a SafetyMonitor: every cycle there are sensors, a state and a command, and the real gate
/// behind the permits. In cycle k: report of tick k−1 → monitor: permit k → tick k, by permit and command k−1.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "gate/gate.h"
#include "safety/conditions/wheeled/wheeled_conditions.h"
#include "safety/derived_limits.h"

namespace robot_control {

inline constexpr std::uint64_t kToMotors = 3;  ///< cycles from a cause to the gate's action

/// Two wheels of 0.1 m radius, 0.5 m apart.
inline DriveTrain two_wheels() {
  DriveTrain robot;
  robot.joints.assign(2, {.name = "wheel", .child_link = "wheel", .effort_limit = 3, .velocity_limit = 20});
  robot.wheels = {{.joint = 0, .centre_base = {0, 0.25, 0}, .radius = 0.1, .width = 0.04, .inertia = 0.005},
                  {.joint = 1, .centre_base = {0, -0.25, 0}, .radius = 0.1, .width = 0.04, .inertia = 0.005}};
  robot.wheels[1].side = Side::kRight;
  robot.contacts = {"left_wheel", "right_wheel"};
  robot.wheel_base = 0.5;
  robot.mass = 12;
  return robot;
}

/// The healthy case stands in READY at cycle kStart, without a request, with encoders of 4096 counts. The heartbeat
/// timeout is 0.3 s, the ramp at most 0.3 s. Two wheels of 0.1 m radius are 0.5 m apart and turn with at most 15 rad/s.
class MonitorTest : public testing::Test {
 protected:
  static constexpr double kPeriod = 1e-3;
  static constexpr std::size_t kWheels = 2;
  static constexpr std::uint64_t kLoss = 20;
  static constexpr std::uint64_t kHeartbeat = 300;
  static constexpr std::uint64_t kRamp = 300;
  static constexpr std::uint64_t kSilence = 1250;  ///< cycles of cmd_vel_timeout
  static constexpr std::uint64_t kStands =
      102;  ///< cycles until it counts as standing: kStandingTime, the anchor, the count
  static constexpr std::uint64_t kStart = 120;
  static constexpr double kQuantum = 2 * std::numbers::pi / 4096;
  static constexpr double kSpeed = 5;             ///< rad/s, when it drives
  static constexpr double kStopDeceleration = 2;  ///< m/s²: a short drive leaves no slide that outlasts kStands

  MonitorTest() {
    sensors_.head.run = 1;
    sensors_.driver_instance = 77;
    sensors_.driver_state = DriverState::kRunning;
    set_joints_valid(sensors_, kValidMotion);
    sensors_.valid = kValidGyro | kValidAccelerometer;
    sensors_.imu.linear_acceleration = {0, 0, 9.81};
    sensors_.joint_count = command_.joint_count = kWheels;
    input_.sensors = &sensors_;
    input_.command = &command_;
    input_.state = &state_;
    while (sensors_.head.cycle < kStart) step();
  }

  static SafetyParameters parameters() {
    SafetyParameters parameters;
    parameters.loss_cycles = kLoss;
    parameters.heartbeat_timeout = static_cast<double>(kHeartbeat) * kPeriod;
    parameters.ramp_time = static_cast<double>(kRamp) * kPeriod;
    parameters.stop_deceleration = kStopDeceleration;
    return derived_limits(parameters, robot(), 15);
  }

  static SafetyParameters without_heartbeat() {
    SafetyParameters chosen = parameters();
    chosen.heartbeat_timeout = 0;
    return chosen;
  }

  static DriveTrain robot() { return two_wheels(); }

  /// Begins the healthy case with another monitor.
  void begin_with(const SafetyParameters& chosen) {
    monitor_ = SafetyMonitor(chosen, robot(), kPeriod);
    new_run();
    steps(kStart);
  }
  /// Begins a run with a zero request, and drives for 100 cycles.
  void drive_with(const SafetyParameters& chosen, const DriveTrain& robot) {
    monitor_ = SafetyMonitor(chosen, robot, kPeriod);
    ask_for(0);
    turn_wheels(0);
    new_run();
    steps(kStart);
    drive();
    steps(100);
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
      sensors_.joints[i].position = quantum_ * std::floor(angle_[i] / quantum_);
      sensors_.joints[i].velocity = speed_[i];
    }
    if (noisy_gyro_) sensors_.imu.angular_velocity[0] = cycle % 2 == 0 ? 1e-4 : -1e-4;
    if (noisy_gyro_) sensors_.imu.linear_acceleration[0] = cycle % 2 == 0 ? 1e-3 : -1e-3;
    command_.head.cycle = cycle == 0 ? 0 : cycle - 1;
    if (fresh_state_) command_.state_cycle = command_.head.cycle;
    if (zero(command_.requested.twist)) ++command_.zero_requests;  // a sender that repeats its request every cycle
    command_.zero_requested = zero(command_.requested.twist) ? 1 : 0;
    command_.silent_cycles = 0;
    command_.silence_needed = kSilence;
    Permit given = permit_;
    given.head = given_head_;
    if (sensors_.head.run != given.head.run) {
      gate_.enter_run();
      next_tick_ = cycle;
    }
    while (next_tick_ < cycle) tick(given);
    sensors_.gate = reported_by(gate_.report());
    monitor_.step(input_, permit_);
    input_.inherited = nullptr;
    given_head_ = sensors_.head;
    tick(given);
  }
  void steps(std::uint64_t cycles) {
    for (std::uint64_t i = 0; i < cycles; ++i) step();
  }
  /// The monitor skips the next `cycles` ones.
  void skip(std::uint64_t cycles) { skip_ = cycles; }
  void new_run() {
    ++sensors_.head.run;
    sensors_.head.cycle = 0;
    begun_ = false;
    command_.zero_requests = command_.first_cycle = state_.first_cycle = 0;
  }
  /// Another monitor, which inherits the last permit in its next step.
  void restart_monitor() {
    last_permit_ = permit_;
    monitor_ = SafetyMonitor(parameters(), robot(), kPeriod);
    inherit({.permit = &last_permit_});
  }
  void inherit(const InheritedLatch& latch) {
    inherited_ = latch;
    input_.inherited = &inherited_;
  }
  /// A step without a sensor frame.
  void wait(SensorSilence silence = SensorSilence::kNone, std::uint64_t corrupt = 0) {
    monitor_.step({.silence = silence, .corrupt = corrupt, .operator_input = input_.operator_input}, permit_);
  }
  /// Requests `linear` m/s, with the wheels' targets; 0: the brake holds.
  void ask_for(double linear) {
    command_.requested.twist.linear[0] = linear;
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
  /// Stands until it counts as standing.
  void stand() {
    ask_for(0);
    turn_wheels(0);
    steps(kStands);
  }
  void request_reset() { ++input_.operator_input.resets; }
  /// Requests a reset, which the next cycle handles.
  std::uint64_t reset() {
    request_reset();
    step();
    EXPECT_EQ(permit_.resets_handled, input_.operator_input.resets);
    return permit_.reset_refusal;
  }
  std::uint64_t cycle() const { return sensors_.head.cycle; }
  bool gate_passes() const { return sensors_.gate.verdict != GateVerdict::kBrake; }

  /// True if every motor brakes in the tick of this cycle.
  bool braked() const {
    const auto brakes = [](const JointCommand& joint) { return joint.mode == JointMode::kBrake; };
    return std::all_of(joints_.begin(), joints_.end(), brakes);
  }
  /// True if the gate passes commands under a ramp.
  bool ramps() const { return gate_.report().verdict == GateVerdict::kRamp; }

  SensorFrame sensors_;
  CommandFrame command_;
  StateFrame state_;
  MonitorInput input_;
  InheritedLatch inherited_;
  Permit last_permit_;  ///< that an earlier monitor left
  SafetyMonitor monitor_{parameters(), robot(), kPeriod};
  Permit permit_;
  double quantum_ = kQuantum;  ///< rad, of the encoders
  bool begun_ = false;
  bool noisy_gyro_ = true;
  bool fresh_state_ = true;  ///< the command descends from the state of its own cycle
  bool gate_obeys_ = true;   ///< false: it reports that it lets everything pass
  bool gate_finds_permit_ = true;
  bool gate_finds_command_ = true;
  bool gate_works_ = true;               ///< false: it reports that it always brakes
  std::uint64_t refused_frames_ = 0;     ///< which it counts beyond its own
  std::array<double, kWheels> speed_{};  ///< rad/s, true

 private:
  /// Runs tick `next_tick_`, with the last permit and the newest command before it.
  void tick(const Permit& permit) {
    if (input_.command != nullptr) {
      heard_ = *input_.command;
      heard_.head = {.run = sensors_.head.run, .cycle = next_tick_ == 0 ? 0 : next_tick_ - 1};
    }
    joints_ = gate_.step({.run = sensors_.head.run,
                          .cycle = next_tick_,
                          .permit_found = Lookup::kFrame,
                          .permit = &permit,
                          .command_found = Lookup::kFrame,
                          .command = &heard_,
                          .sensors = &sensors_});
    ++next_tick_;
  }

  /// The report of a gate that works and follows the permit, or does not.
  GateReport reported_by(const GateReport& true_report) const {
    constexpr std::uint64_t kRefusal = kGateNoPermit | kGatePermitExpired | kGatePermitBrake | kGateRampOver;
    GateReport report = true_report;
    report.refused += refused_frames_;
    if (!gate_finds_permit_) report.reasons |= kGateNoPermit;
    if (!gate_finds_command_) report.command_cycle = 0;
    if (!gate_works_ && report.verdict != GateVerdict::kBrake) report.verdict = GateVerdict::kBrake;
    if (!gate_obeys_ && (report.reasons & kRefusal) != 0) report.verdict = GateVerdict::kPassed;
    return report;
  }

  std::uint64_t skip_ = 0;
  std::array<double, kWheels> angle_{};
  // Only the joints' efforts are limited: the gate then needs no samples, and stays well when sensors are not.
  Gate gate_{std::vector<JointLimits>(kWheels, {.effort = 3}), {.longest_ramp = kRamp + kLoss}, kPeriod};
  std::uint64_t next_tick_ = 0;
  FrameHead given_head_;  ///< of the last permit
  CommandFrame heard_;    ///< by the gate
  std::span<const JointCommand> joints_;
};

}  // namespace robot_control
