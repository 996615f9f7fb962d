#include "safety/safety_monitor.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "safety/stop_category.h"

namespace robot_control {
namespace {

const SafetyParameters& checked(const SafetyParameters& parameters, double period) {
  const auto require = [](bool holds, const std::string& rule) {
    if (!holds) throw std::invalid_argument("safety monitor: " + rule);
  };
  require(period > 0 && std::isfinite(period), "period must be > 0 s, is " + std::to_string(period));
  require(parameters.loss_cycles > 0, "loss_cycles must be > 0");
  require(parameters.heartbeat_timeout >= 0 && std::isfinite(parameters.heartbeat_timeout),
          "heartbeat_timeout must be >= 0 s, is " + std::to_string(parameters.heartbeat_timeout));
  require(parameters.ramp_time >= 0 && std::isfinite(parameters.ramp_time),
          "ramp_time must be >= 0 s, is " + std::to_string(parameters.ramp_time));
  require(parameters.standstill_speed > 0 && std::isfinite(parameters.standstill_speed),
          "standstill_speed must be > 0 rad/s, is " + std::to_string(parameters.standstill_speed));
  return parameters;
}

bool zero(const Vector3& vector) noexcept {
  return vector[0] == 0 && vector[1] == 0 && vector[2] == 0;
}

bool asks_for_motion(const CommandFrame* command) noexcept {
  return command != nullptr && !(zero(command->twist_requested.linear) && zero(command->twist_requested.angular));
}

}  // namespace

SafetyMonitor::SafetyMonitor(const SafetyParameters& parameters, const RobotModel& robot, double period)
    : conditions_(checked(parameters, period), period),
      standstill_(parameters.standstill_speed, robot.wheels.size()),
      supervisor_(static_cast<std::uint64_t>(std::llround(parameters.ramp_time / period))) {}

void SafetyMonitor::reset(const OperatorInput& operator_input) noexcept {
  conditions_.enter_run(operator_input);
  standstill_.reset();
  supervisor_.enter_run();
  cycle_.reset();
  active_ = 0;
  if (resets_handled_ != operator_input.resets) reset_refusal_ = kRefusalInit;
  resets_handled_ = operator_input.resets;
}

void SafetyMonitor::resume(const Permit& last) noexcept {
  last_ = last;
}

void SafetyMonitor::driver_lost() noexcept {
  if (driver_known_ && !driver_paused_) pending_ |= kCauseDriverLost;
}

void SafetyMonitor::refuse_reset(const OperatorInput& operator_input, ResetRefusal why) noexcept {
  resets_handled_ = operator_input.resets;
  reset_refusal_ = why;
}

void SafetyMonitor::decide_restart(const SensorFrame& sensors) noexcept {
  if (driver_known_) return;
  const bool continued = last_ && last_->boot == sensors.boot;
  const Permit last = continued ? *last_ : Permit{};
  last_.reset();
  if (!continued && sensors.gate.permit_cycle == 0) return;
  supervisor_.restore(last.causes, last.first_cause, kCauseMonitorRestarted, sensors.head.cycle);
  pending_ |= kCauseMonitorRestarted;
  if ((last.active & kCauseEmergencyStopTopic) != 0) conditions_.hold_e_stop();
}

void SafetyMonitor::step(const MonitorInput& input, Permit& out) noexcept {
  const SensorFrame& sensors = *input.sensors;
  decide_restart(sensors);
  driver_known_ = true;
  driver_paused_ = sensors.driver_state == DriverState::kPaused;

  const bool again = cycle_ == sensors.head.cycle;
  if (!again) {
    cycle_ = sensors.head.cycle;
    active_ = conditions_.step(input, supervisor_.state() == SupervisorState::kDrive);
    standstill_.step(sensors);
  }
  active_ |= pending_;
  pending_ = 0;

  SupervisorInput facts;
  facts.cycle = sensors.head.cycle;
  facts.active = active_;
  facts.missing = conditions_.missing();
  facts.requested = asks_for_motion(input.command);
  facts.moving = standstill_.moving();
  facts.standing = standstill_.standing();
  facts.reset_requested = !again && input.operator_input.resets != resets_handled_;
  supervisor_.step(facts);
  if (facts.reset_requested) {
    resets_handled_ = input.operator_input.resets;
    reset_refusal_ = supervisor_.reset_refusal();
  }

  out.state = supervisor_.state();
  out.action = action_in(out.state);
  out.ramp_until = supervisor_.ramp_until();
  out.expiry = sensors.head.cycle + kPermitLife;
  out.causes = supervisor_.causes();
  out.active = active_;
  out.first_cause = supervisor_.first_cause();
  out.since_cycle = supervisor_.since_cycle();
  out.missing = facts.missing;
  out.boot = sensors.boot;
  out.resets_handled = resets_handled_;
  out.reset_refusal = reset_refusal_;
}

}  // namespace robot_control
