#pragma once
/// The law of the monitor: conditions of one cycle → permit of that cycle. The conditions of any machine are here;
/// those of one robot kind are its parameter.
///
///   conditions ─► active causes, by reaction ─► Warnings: reported, may limit the speed    ─► Permit
///                 (ActiveCauses)            └─► Supervisor: latch, state table ─► action
///
///   presence.h, sensor_presence.h, frame_conditions.h    which input is missing or cannot be trusted
///   motion_release.h                                     was a zero velocity requested since the last start
///   operator_conditions.h, clearance.h                   what the operator commands
///   gate_conditions.h, machine_conditions.h              does the gate obey, does the driver report a fault
///   KindConditions                                       how joints and body move, compared with limits and targets
///                                                        (conditions/common/condition_set.h)
///
/// One `step` is made per cycle with that cycle's sensor frame. A step without a frame is made when the driver is
/// silent and something else happened (SensorSilence, a corrupt frame, a request of the operator). It evaluates no
/// condition on sensors, refuses resets and latches emergency stops. An equal step after it latches nothing.
///
/// INIT ends when all of these hold:
///
///   sensors, state and command of this run were each received once
///   the gate has found a permit and a command
///   the machine is ready
///   motion is released (motion_release.h)
///
/// While the machine is starting, no condition on joints and IMU is evaluated. READY and DRIVE permit motion until a
/// node is restarted or a cause latches a stop (fixed_reactions.h, SafetyParameters); STOPPING permits a ramp at most,
/// STOPPED and FAULT nothing: supervisor_table.h. The permit of cycle k expires after cycle k + kPermitLife, so a
/// monitor that makes no progress permits no motion.
///
/// Driver lost latches in two cases.
///   wall clock  no current sensor frame arrives
///   any clock   a frame carries another SensorFrame::driver_instance than the frame before it
/// A restarted driver therefore counts as lost, however short the interruption was and whatever the driver reported
/// last. A reset of the simulation keeps the driver instance. A driver that reports its end (DriverState::kEnded) is
/// missing, not lost: the state becomes INIT, or a latched stop stays.
///
/// A latch outlives all processes. A restarted monitor inherits the causes of the last permit in the channel, for any
/// driver instance, and those of latch_file. They are latched at once, and only an accepted reset clears them. An
/// `e_stop` topic that was true counts as true until its next message. The restart itself is a cause if that driver
/// instance still runs or the gate has used a permit of this run.
///
/// Permit::withdrawals counts starts (motion_release.h), latched causes and the end of an earlier monitor. A request
/// from before one of them moves nothing after it (ros/inputs/motion_requests.h).
///
/// The speed limit of a permit is the smaller of the limit that the clearance gives and slow_speed. The latter applies
/// while a cause with Reaction::kSlow is active and for kWarningHold after it (warnings.h). It never latches.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "safety/conditions/common/frame_conditions.h"
#include "safety/conditions/common/gate_conditions.h"
#include "safety/conditions/common/machine_conditions.h"
#include "safety/conditions/common/operator_conditions.h"
#include "safety/conditions/common/presence.h"
#include "safety/conditions/common/sensor_presence.h"
#include "safety/latch/active_causes.h"
#include "safety/latch/evidence.h"
#include "safety/latch/fixed_reactions.h"
#include "safety/latch/motion_release.h"
#include "safety/latch/supervisor.h"
#include "safety/latch/warnings.h"
#include "safety/measurements/clearance.h"
#include "safety/monitor_input.h"
#include "safety/parameter_check.h"
#include "safety/safety_parameters.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// KindConditions is trivially copyable and has
///
///   KindConditions(const SafetyParameters&, const Machine&, double period)
///   driven_joints(const Machine&)   number of joints, from the first one, whose sensors must report
///   enter_run()                     a new run
///   step(const MonitorInput&, elapsed, speed_limit, ActiveCauses&)
///                                   one cycle with a sensor frame; speed_limit [m/s] is that of the last permit
///   moving(), standing()            what the joints show; after a start neither
///   sliding()                       it stands, but may slide
template <class KindConditions>
class Monitor {
 public:
  /// `period` s. A condition without a limit is not evaluated. Throws std::invalid_argument for parameters that
  /// parameter_check.h refuses.
  template <class Machine>
  Monitor(const SafetyParameters& parameters, const Machine& machine, double period)
      : slow_speed_(checked(parameters, period).slow_speed),
        presence_(parameters.loss_cycles),
        sensor_presence_(parameters, KindConditions::driven_joints(machine), period),
        operator_conditions_(parameters.heartbeat_timeout, period),
        clearance_(parameters, period),
        kind_(parameters, machine, period),
        gate_conditions_(parameters.loss_cycles, period),
        machine_conditions_(parameters, period),
        warnings_(period),
        supervisor_(static_cast<std::uint64_t>(std::llround(parameters.ramp_time / period))) {}

  /// Fills everything but `out.head`. The first frame of another run restarts all counters and conditions. Heartbeats
  /// and resets received before that frame have no effect (kRefusalInit); emergency stops do.
  void step(const MonitorInput& input, Permit& out) noexcept;

 private:
  void restore(const InheritedLatch& latch) noexcept;
  void enter_run(const MonitorInput& input) noexcept;
  void evaluate_frame(const MonitorInput& input) noexcept;
  void evaluate_silence(const MonitorInput& input) noexcept;
  void end_run(bool driver_ended) noexcept;
  void evaluate_conditions(const MonitorInput& input) noexcept;
  std::uint64_t missing() const noexcept;
  void supervise(const MonitorInput& input) noexcept;
  void write(Permit& out) const noexcept;
  double speed_limit(const OperatorInput& operator_input) const noexcept;

  double slow_speed_;
  Presence presence_;
  SensorPresence sensor_presence_;
  FrameConditions frame_conditions_;
  OperatorConditions operator_conditions_;
  Clearance clearance_;
  KindConditions kind_;
  GateConditions gate_conditions_;
  MachineConditions machine_conditions_;
  ActiveCauses active_;  ///< of the last step
  Warnings warnings_;
  Evidence evidence_;
  Supervisor supervisor_;
  MotionRelease release_;
  std::optional<std::uint64_t> earlier_driver_instance_;  ///< Permit::driver_instance of an earlier monitor
  std::uint64_t earlier_withdrawals_ = 0;                 ///< those of an earlier monitor, and its end
  std::optional<std::uint64_t> driver_;                   ///< SensorFrame::driver_instance of the last frame
  std::uint64_t run_ = 0;                                 ///< of the last frame
  std::optional<std::uint64_t> cycle_;                    ///< of the last frame
  bool driver_ended_ = false;
  bool motion_requested_ = false;  ///< by the command of the last frame
  double last_speed_limit_ = kNoSpeedLimit;
  std::uint64_t resets_handled_ = 0;
  std::uint64_t reset_refusal_ = 0;
};

template <class KindConditions>
void Monitor<KindConditions>::step(const MonitorInput& input, Permit& out) noexcept {
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

template <class KindConditions>
void Monitor<KindConditions>::restore(const InheritedLatch& latch) noexcept {
  const Permit* last = latch.permit;
  if (last != nullptr) {
    earlier_driver_instance_ = last->driver_instance;
    earlier_withdrawals_ = last->withdrawals + 1;
    supervisor_.restore(last->causes, last->first_cause);
    evidence_.restore(*last);
  }
  supervisor_.restore(latch.causes, latch.first_cause);
  const std::uint64_t active = last != nullptr ? last->active : latch.causes;
  operator_conditions_.restore(active);
}

template <class KindConditions>
void Monitor<KindConditions>::enter_run(const MonitorInput& input) noexcept {
  presence_.enter_run();
  sensor_presence_.enter_run();
  frame_conditions_.enter_run();
  operator_conditions_.enter_run(input.operator_input);
  kind_.enter_run();
  gate_conditions_.enter_run();
  machine_conditions_.enter_run();
  release_.enter_run();
  warnings_.enter_run();
  supervisor_.enter_run();
  cycle_.reset();
  run_ = input.sensors->head.run;
  if (resets_handled_ != input.operator_input.resets) reset_refusal_ = kRefusalInit;
  resets_handled_ = input.operator_input.resets;
}

template <class KindConditions>
void Monitor<KindConditions>::evaluate_frame(const MonitorInput& input) noexcept {
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
  motion_requested_ = input.command != nullptr && parts_of(input.command->requested) != 0;
  end_run(sensors.driver_state == DriverState::kEnded);
}

template <class KindConditions>
void Monitor<KindConditions>::evaluate_silence(const MonitorInput& input) noexcept {
  operator_conditions_.step(input, false, active_);
  if (!driver_) return;
  frame_conditions_.step(input, active_);
  if (input.silence == SensorSilence::kTimedOut) active_.add(kCauseDriverLost, Reaction::kBrake, {.beyond = true});
  end_run(input.silence == SensorSilence::kEnded);
}

template <class KindConditions>
void Monitor<KindConditions>::end_run(bool driver_ended) noexcept {
  if (driver_ended && !driver_ended_) {
    presence_.enter_run();
    release_.enter_run();
    supervisor_.enter_run();
  }
  driver_ended_ = driver_ended;
}

template <class KindConditions>
void Monitor<KindConditions>::evaluate_conditions(const MonitorInput& input) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const std::uint64_t cycle = sensors.head.cycle;
  const std::uint64_t elapsed = cycle_ ? cycle - *cycle_ : 1;
  cycle_ = cycle;
  presence_.step(input, elapsed, active_);
  release_.step(input, elapsed);
  machine_conditions_.step(sensors, elapsed, active_);
  if (!machine_conditions_.starting()) sensor_presence_.step(sensors, elapsed, active_);
  frame_conditions_.step(input, active_);
  operator_conditions_.step(input, supervisor_.state() == SupervisorState::kDrive, active_);
  gate_conditions_.step(sensors, active_);
  if (!machine_conditions_.starting()) kind_.step(input, elapsed, last_speed_limit_, active_);
  warnings_.step(active_, cycle, elapsed);
}

template <class KindConditions>
std::uint64_t Monitor<KindConditions>::missing() const noexcept {
  return presence_.missing() | (machine_conditions_.starting() ? std::uint64_t{kMissingMachine} : 0);
}

template <class KindConditions>
void Monitor<KindConditions>::supervise(const MonitorInput& input) noexcept {
  const bool has_frame = input.sensors != nullptr;
  const bool reset_requested = input.operator_input.resets != resets_handled_;
  const std::uint64_t brake = active_.with(Reaction::kBrake);
  SupervisorInput supervised;
  supervised.cycle = cycle_.value_or(0);
  supervised.fault = leading_to_fault(brake);
  supervised.brake = brake & ~supervised.fault;
  supervised.ramp = active_.with(Reaction::kRamp);
  supervised.missing = missing();
  supervised.released = release_.released();
  supervised.requested = motion_requested_;
  supervised.motion_refusal = release_.reset_refusal();
  supervised.moving = kind_.moving();
  supervised.standing = kind_.standing();
  supervised.sliding = kind_.sliding();
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

template <class KindConditions>
double Monitor<KindConditions>::speed_limit(const OperatorInput& operator_input) const noexcept {
  const double clear = clearance_.speed_limit(operator_input);
  return warnings_.slowing() ? std::min(clear, slow_speed_) : clear;
}

template <class KindConditions>
void Monitor<KindConditions>::write(Permit& out) const noexcept {
  out.state = supervisor_.state();
  out.action = action_in(out.state);
  out.ramp_until = supervisor_.ramp_until();
  out.expiry = cycle_.value_or(0) + kPermitLife;
  out.causes = supervisor_.causes();
  out.active = active_.stopping();
  out.first_cause = supervisor_.first_cause();
  out.warnings = warnings_.bits();
  out.since_cycle = supervisor_.since_cycle();
  out.missing = missing();
  out.unreleased = release_.released() ? 0 : 1;
  out.withdrawals = earlier_withdrawals_ + release_.starts() + supervisor_.stops();
  out.driver_instance = driver_ ? *driver_ : earlier_driver_instance_.value_or(0);
  out.resets_handled = resets_handled_;
  out.reset_refusal = reset_refusal_;
  out.speed_limit = last_speed_limit_;
  evidence_.write(warnings_, out.evidence);
}

}  // namespace robot_control
