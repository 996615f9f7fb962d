#include "safety/safety_monitor.h"

#include <algorithm>
#include <cmath>

#include "safety/latch/fixed_reactions.h"
#include "safety/parameter_check.h"

namespace robot_control {

SafetyMonitor::SafetyMonitor(const SafetyParameters& parameters, const DriveTrain& robot, double period)
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
      rim_speed_(robot),
      body_conditions_(parameters, robot, middle_of_axles(robot), period),
      warnings_(period),
      supervisor_(static_cast<std::uint64_t>(std::llround(parameters.ramp_time / period))) {}

void SafetyMonitor::step(const MonitorInput& input, Permit& out) noexcept {
  active_.clear();
  if (input.inherited != nullptr) restore(*input.inherited);
  if (input.sensors != nullptr) {
    evaluate_frame(input);
  } else {
    evaluate_silence(input);
  }
  supervise(input);
  last_speed_limit_ = speed_limit(input.operator_input);
  write(out);
  if (input.sensors != nullptr) gate_conditions_.remember(out, *cycle_);
}

void SafetyMonitor::restore(const InheritedLatch& latch) noexcept {
  const Permit* last = latch.permit;
  if (last != nullptr) {
    earlier_driver_instance_ = last->driver_instance;
    earlier_withdrawals_ = last->withdrawals + 1;
    supervisor_.restore(last->causes, last->first_cause);
    evidence_.restore(*last);
  }
  supervisor_.restore(latch.causes, latch.first_cause);
  const std::uint64_t active = last != nullptr ? last->active : latch.causes;
  if ((active & kCauseEmergencyStopTopic) != 0) operator_conditions_.hold_e_stop();
}

void SafetyMonitor::enter_run(const MonitorInput& input) noexcept {
  presence_.enter_run();
  sensor_presence_.enter_run();
  frame_conditions_.enter_run();
  operator_conditions_.enter_run(input.operator_input);
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
  warnings_.enter_run();
  supervisor_.enter_run();
  cycle_.reset();
  run_ = input.sensors->head.run;
  if (resets_handled_ != input.operator_input.resets) reset_refusal_ = kRefusalInit;
  resets_handled_ = input.operator_input.resets;
}

void SafetyMonitor::evaluate_frame(const MonitorInput& input) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const bool first = !driver_;
  const bool monitor_restarted =
      first && (earlier_driver_instance_ == sensors.driver_instance || sensors.gate.permit_cycle != 0);
  const bool driver_restarted = !first && *driver_ != sensors.driver_instance;
  driver_ = sensors.driver_instance;
  if (run_ != sensors.head.run) enter_run(input);
  evaluate_conditions(input);
  if (monitor_restarted) active_.add(kCauseMonitorRestarted, Reaction::kBrake, {.beyond = true});
  if (driver_restarted) active_.add(kCauseDriverLost, Reaction::kBrake, {.beyond = true});
  motion_requested_ = input.command != nullptr && !zero(input.command->requested.twist);
  end_run(sensors.driver_state == DriverState::kEnded);
}

void SafetyMonitor::evaluate_silence(const MonitorInput& input) noexcept {
  operator_conditions_.step(input, false, active_);
  if (!driver_) return;
  frame_conditions_.step(input, active_);
  if (input.silence == SensorSilence::kTimedOut) active_.add(kCauseDriverLost, Reaction::kBrake, {.beyond = true});
  end_run(input.silence == SensorSilence::kEnded);
}

void SafetyMonitor::end_run(bool driver_ended) noexcept {
  if (driver_ended && !driver_ended_) {
    presence_.enter_run();
    release_.enter_run();
    supervisor_.enter_run();
  }
  driver_ended_ = driver_ended;
}

void SafetyMonitor::evaluate_conditions(const MonitorInput& input) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const std::uint64_t cycle = sensors.head.cycle;
  const std::uint64_t elapsed = cycle_ ? cycle - *cycle_ : 1;
  cycle_ = cycle;
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
  body_conditions_.step(sensors, elapsed, rim_speed_.value(sensors), standstill_.moving(), active_);
}

void SafetyMonitor::supervise(const MonitorInput& input) noexcept {
  const bool has_frame = input.sensors != nullptr;
  const bool reset_requested = input.operator_input.resets != resets_handled_;
  const std::uint64_t brake = active_.with(Reaction::kBrake);
  SupervisorInput supervised;
  supervised.cycle = cycle_.value_or(0);
  supervised.fault = leading_to_fault(brake);
  supervised.brake = brake & ~supervised.fault;
  supervised.ramp = active_.with(Reaction::kRamp);
  supervised.missing = presence_.missing();
  supervised.released = release_.released();
  supervised.requested = motion_requested_;
  supervised.no_motion_requested = release_.no_motion_requested();
  supervised.moving = standstill_.moving();
  supervised.standing = standstill_.standing();
  supervised.sliding = standstill_.standing() && slide_.possible();
  supervised.reset_requested = reset_requested && has_frame;
  supervisor_.step(supervised);
  if (reset_requested) {
    const auto silent = input.silence == SensorSilence::kPaused ? kRefusalPaused : kRefusalSilent;
    resets_handled_ = input.operator_input.resets;
    reset_refusal_ = has_frame ? supervisor_.reset_refusal() : silent;
  }
  if (supervisor_.causes() == 0) evidence_.clear();
  evidence_.latch(active_, supervised.cycle);
}

double SafetyMonitor::speed_limit(const OperatorInput& operator_input) const noexcept {
  const double clear = clearance_.speed_limit(operator_input);
  return warnings_.slowing() ? std::min(clear, slow_speed_) : clear;
}

void SafetyMonitor::write(Permit& out) const noexcept {
  out.state = supervisor_.state();
  out.action = action_in(out.state);
  out.ramp_until = supervisor_.ramp_until();
  out.expiry = cycle_.value_or(0) + kPermitLife;
  out.causes = supervisor_.causes();
  out.active = active_.stopping();
  out.first_cause = supervisor_.first_cause();
  out.warnings = warnings_.bits();
  out.since_cycle = supervisor_.since_cycle();
  out.missing = presence_.missing();
  out.unreleased = release_.released() ? 0 : 1;
  out.withdrawals = earlier_withdrawals_ + release_.starts() + supervisor_.stops();
  out.driver_instance = driver_ ? *driver_ : earlier_driver_instance_.value_or(0);
  out.resets_handled = resets_handled_;
  out.reset_refusal = reset_refusal_;
  out.speed_limit = last_speed_limit_;
  evidence_.write(warnings_, out.evidence);
}

}  // namespace robot_control
