#include "safety/safety_monitor.h"

#include <algorithm>
#include <cmath>

#include "safety/latch/fixed_reactions.h"
#include "safety/parameter_check.h"

namespace robot_control {
namespace {

bool requests_motion(const CommandFrame* command) noexcept {
  return command != nullptr && !zero(command->twist_requested);
}

ConditionMeasurement counted(double count) noexcept {
  return {.beyond = true, .value = count, .limit = count};
}

}  // namespace

SafetyMonitor::SafetyMonitor(const SafetyParameters& parameters, const RobotModel& robot, double period)
    : slow_speed_(checked(parameters, period).slow_speed),
      presence_(parameters.loss_cycles),
      sensor_presence_(parameters, robot.wheels.size(), period),
      operator_conditions_(parameters.heartbeat_timeout, period),
      clearance_(parameters),
      motion_(robot.wheels.size(), period),
      standstill_(parameters.standstill_speed, period),
      slide_(parameters, robot, period),
      targets_(robot.wheels.size()),
      wheel_limits_(parameters, robot, period),
      wheel_following_(parameters, robot, period),
      torque_oscillation_(parameters, robot, period),
      yaw_agreement_(parameters.yaw_rate, robot, period),
      gate_conditions_(parameters.loss_cycles, period),
      machine_conditions_(parameters, period),
      body_conditions_(parameters, robot, period),
      warnings_(period),
      supervisor_(static_cast<std::uint64_t>(std::llround(parameters.ramp_time / period))) {}

void SafetyMonitor::enter_run(const OperatorInput& operator_input) noexcept {
  presence_.enter_run();
  sensor_presence_.enter_run();
  frame_conditions_.enter_run();
  operator_conditions_.enter_run(operator_input);
  motion_.enter_run();
  standstill_.enter_run();
  slide_.enter_run();
  targets_.enter_run();
  wheel_limits_.enter_run();
  wheel_following_.enter_run();
  torque_oscillation_.enter_run();
  yaw_agreement_.enter_run();
  gate_conditions_.enter_run();
  machine_conditions_.enter_run();
  body_conditions_.enter_run();
  release_.enter_run();
  active_.clear();
  warnings_.enter_run();
  supervisor_.enter_run();
  cycle_.reset();
  if (resets_handled_ != operator_input.resets) reset_refusal_ = kRefusalInit;
  resets_handled_ = operator_input.resets;
}

void SafetyMonitor::restore(const Permit& last) noexcept {
  earlier_driver_instance_ = last.driver_instance;
  earlier_withdrawals_ = last.withdrawals + 1;
  supervisor_.restore(last.causes, last.first_cause);
  evidence_.restore(last);
  if ((last.active & kCauseEmergencyStopTopic) != 0) operator_conditions_.hold_e_stop();
}

void SafetyMonitor::restore(std::uint64_t causes, std::uint64_t first_cause) noexcept {
  supervisor_.restore(causes, first_cause);
  const bool no_permit = !earlier_driver_instance_;
  if (no_permit && (causes & kCauseEmergencyStopTopic) != 0) operator_conditions_.hold_e_stop();
}

void SafetyMonitor::driver_lost() noexcept {
  if (driver_ && !driver_silence_expected_) pending_ |= kCauseDriverLost;
}

void SafetyMonitor::driver_ended() noexcept {
  driver_silence_expected_ = true;
  presence_.enter_run();
  release_.enter_run();
  supervisor_.enter_run();
}

void SafetyMonitor::sensors_corrupt() noexcept {
  pending_ |= kCauseCorruptFrame;
}

void SafetyMonitor::refuse_reset(const OperatorInput& operator_input, ResetRefusal why) noexcept {
  resets_handled_ = operator_input.resets;
  reset_refusal_ = why;
}

bool SafetyMonitor::note_emergency_stop(const OperatorInput& operator_input) noexcept {
  const std::uint64_t stops = operator_conditions_.emergency_stops(operator_input) & ~active_.stopping();
  pending_ |= stops;
  return stops != 0;
}

void SafetyMonitor::detect_monitor_restart(const SensorFrame& sensors) noexcept {
  const bool continued = earlier_driver_instance_ == sensors.driver_instance;
  earlier_driver_instance_.reset();
  if (first_cycle_) release_.begin(*first_cycle_);
  if (continued || sensors.gate.permit_cycle != 0) pending_ |= kCauseMonitorRestarted;
}

void SafetyMonitor::check_driver_instance(const SensorFrame& sensors) noexcept {
  if (!driver_) detect_monitor_restart(sensors);
  if (driver_ && *driver_ != sensors.driver_instance) pending_ |= kCauseDriverLost;
  driver_ = sensors.driver_instance;
  driver_silence_expected_ =
      sensors.driver_state == DriverState::kPaused || sensors.driver_state == DriverState::kEnded;
}

void SafetyMonitor::evaluate_conditions(const MonitorInput& input) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const std::uint64_t cycle = sensors.head.cycle;
  const std::uint64_t elapsed = cycle_ ? cycle - *cycle_ : 1;
  active_.clear();
  presence_.step(input, elapsed, active_);
  release_.step(input, elapsed);
  sensor_presence_.step(sensors, elapsed, active_);
  frame_conditions_.step(input, active_);
  operator_conditions_.step(input, supervisor_.state() == SupervisorState::kDrive, active_);
  machine_conditions_.step(sensors, elapsed, active_);
  gate_conditions_.step(sensors, elapsed, active_);
  evaluate_motion(input, elapsed);
  warnings_.step(active_, cycle, elapsed);
}

void SafetyMonitor::evaluate_motion(const MonitorInput& input, std::uint64_t elapsed) noexcept {
  const SensorFrame& sensors = *input.sensors;
  motion_.step(sensors);
  standstill_.step(motion_, sensors.head.cycle);
  slide_.step(motion_, standstill_.standing(), elapsed);
  targets_.step(input);
  wheel_limits_.step(sensors, motion_, targets_.passed(), last_speed_limit_, elapsed, active_);
  wheel_following_.step(sensors, targets_, motion_, standstill_, elapsed, active_);
  torque_oscillation_.step(input, targets_, motion_, elapsed, active_);
  yaw_agreement_.step(sensors, motion_, elapsed, active_);
  body_conditions_.step(sensors, elapsed, standstill_.moving(), active_);
}

void SafetyMonitor::add_pending() noexcept {
  constexpr auto kCorrupt = static_cast<double>(FrameConditions::kPersistence);
  for (std::uint64_t rest = pending_; rest != 0; rest &= rest - 1) {
    const auto cause = static_cast<StopCause>(rest & (~rest + 1));
    ConditionMeasurement measurement{.beyond = true};
    if (cause == kCauseCorruptFrame) measurement = counted(kCorrupt);
    active_.add(cause, Reaction::kBrake, measurement);
  }
  pending_ = 0;
}

void SafetyMonitor::supervise(const MonitorInput& input, bool repeated) noexcept {
  const std::uint64_t cycle = input.sensors->head.cycle;
  const std::uint64_t brake = active_.with(Reaction::kBrake);
  SupervisorInput supervised;
  supervised.cycle = cycle;
  supervised.fault = leading_to_fault(brake);
  supervised.brake = brake & ~supervised.fault;
  supervised.ramp = active_.with(Reaction::kRamp);
  supervised.missing = presence_.missing();
  supervised.released = release_.released();
  supervised.requested = requests_motion(input.command);
  supervised.no_motion_requested = release_.no_motion_requested();
  supervised.moving = standstill_.moving();
  supervised.standing = standstill_.standing();
  supervised.sliding = standstill_.standing() && slide_.possible();
  supervised.reset_requested = !repeated && input.operator_input.resets != resets_handled_;
  supervisor_.step(supervised);
  if (supervised.reset_requested) {
    resets_handled_ = input.operator_input.resets;
    reset_refusal_ = supervisor_.reset_refusal();
  }
  if (supervisor_.causes() == 0) evidence_.clear();
  evidence_.latch(active_, cycle);
}

double SafetyMonitor::speed_limit(const OperatorInput& operator_input) const noexcept {
  const double clear = clearance_.speed_limit(operator_input);
  return warnings_.slowing() ? std::min(clear, slow_speed_) : clear;
}

void SafetyMonitor::step(const MonitorInput& input, Permit& out) noexcept {
  const SensorFrame& sensors = *input.sensors;
  check_driver_instance(sensors);
  const bool repeated = cycle_ == sensors.head.cycle;
  if (!repeated) evaluate_conditions(input);
  cycle_ = sensors.head.cycle;
  add_pending();
  supervise(input, repeated);
  last_speed_limit_ = speed_limit(input.operator_input);
  write(sensors.head.cycle, sensors.driver_instance, out);
  if (!repeated) gate_conditions_.remember(out, sensors.head.cycle);
}

void SafetyMonitor::step_without_sensors(const OperatorInput& operator_input, Permit& out) noexcept {
  active_.clear();
  pending_ |= operator_conditions_.emergency_stops(operator_input);
  add_pending();
  supervisor_.step({.brake = active_.with(Reaction::kBrake), .missing = presence_.missing()});
  evidence_.latch(active_, 0);
  last_speed_limit_ = speed_limit(operator_input);
  write(0, earlier_driver_instance_.value_or(0), out);
}

void SafetyMonitor::write(std::uint64_t cycle, std::uint64_t driver_instance, Permit& out) const noexcept {
  out.state = supervisor_.state();
  out.action = action_in(out.state);
  out.ramp_until = supervisor_.ramp_until();
  out.expiry = cycle + kPermitLife;
  out.causes = supervisor_.causes();
  out.active = active_.stopping();
  out.first_cause = supervisor_.first_cause();
  out.warnings = warnings_.bits();
  out.since_cycle = supervisor_.since_cycle();
  out.missing = presence_.missing();
  out.unreleased = release_.released() ? 0 : 1;
  out.withdrawals = earlier_withdrawals_ + release_.starts() + supervisor_.stops();
  out.driver_instance = driver_instance;
  out.resets_handled = resets_handled_;
  out.reset_refusal = reset_refusal_;
  out.speed_limit = last_speed_limit_;
  evidence_.write(warnings_, out.evidence);
}

}  // namespace robot_control
