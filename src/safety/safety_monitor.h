#pragma once
/// safety_monitor's law: facts of one cycle → permit of that cycle.
///
///   facts ─► causes by reaction ─► warnings: told, slowed down for        ─► Permit
///            (ActiveCauses)    └─► Supervisor: latch, table ─► action
///
///   presence.h, sensor_presence.h, frame_facts.h    what is missing, what cannot be trusted
///   motion_release.h                                was a zero velocity requested since the last start
///   operator_facts.h, clearance.h                   what the operator says
///   wheel_motion.h ─► wheel_limits.h, wheel_following.h, torque_oscillation.h, yaw_agreement.h, standstill.h,
///                      slide.h
///   gate_facts.h, machine_facts.h, body_facts.h     does the machine obey, is it well, what happens to its body
///
/// INIT until sensors, state and command of this run were each seen and motion is released; then READY or DRIVE permit
/// motion until a node is started again or a cause latches a stop (stop_category.h, SafetyParameters). The permit of
/// cycle k is alive until k + kPermitLife: a monitor that makes no progress permits nothing.
///
/// The driver is lost when no current sensor frame comes (wall clock), and when a frame carries another
/// SensorFrame::boot than the one before it (any clock): a driver that was restarted is lost however soon it came back,
/// whatever it last reported. A simulation that is reset keeps its boot. A driver that reports its end
/// (DriverState::kEnded) is missing, not lost: INIT, or what is latched.
///
/// A latch outlives its processes: a monitor that starts restores the causes of the last permit of the channel,
/// whichever driver it was issued for, and those of latch_file; only an accepted reset clears them.
///
/// The speed limit of a permit is the least of slow_speed, where a cause slows the robot down, and of what the
/// clearance allows; it latches nothing.

#include <cstdint>
#include <optional>

#include "robot/robot_model.h"
#include "safety/conditions/body_facts.h"
#include "safety/conditions/frame_facts.h"
#include "safety/conditions/gate_facts.h"
#include "safety/conditions/machine_facts.h"
#include "safety/conditions/operator_facts.h"
#include "safety/conditions/presence.h"
#include "safety/conditions/sensor_presence.h"
#include "safety/conditions/torque_oscillation.h"
#include "safety/conditions/wheel_following.h"
#include "safety/conditions/wheel_limits.h"
#include "safety/conditions/yaw_agreement.h"
#include "safety/latch/active_causes.h"
#include "safety/latch/evidence.h"
#include "safety/latch/motion_release.h"
#include "safety/latch/supervisor.h"
#include "safety/latch/warnings.h"
#include "safety/measurements/clearance.h"
#include "safety/measurements/joint_standstill.h"
#include "safety/measurements/slide.h"
#include "safety/measurements/wheel_motion.h"
#include "safety/measurements/wheel_targets.h"
#include "safety/monitor_input.h"
#include "safety/safety_parameters.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

class SafetyMonitor {
 public:
  /// `period` s. Limits that are absent are none: derived_limits.h fills them. Throws std::invalid_argument: what
  /// parameter_check.h refuses.
  SafetyMonitor(const SafetyParameters& parameters, const RobotModel& robot, double period);

  /// A new run: sightings and counts begin anew; latched causes stay. `operator_input` is the inbox now:
  /// resets and heartbeats in it are dropped, emergency stops that were not yet acted on are not.
  void reset(const OperatorInput& operator_input) noexcept;

  /// After a restart of the monitor: `last` is what the channel still holds. Its causes are latched at once. If the
  /// driver that `last` was issued for still runs at the first step, kCauseMonitorRestarted is added. Without a
  /// readable `last` the gate shows it: one that has used a permit of this run was served by an earlier monitor.
  void restore(const Permit& last) noexcept;

  /// Latches `causes` at once, as found in another record of an earlier stop.
  void restore(std::uint64_t causes, std::uint64_t first_cause) noexcept;

  /// This monitor was started in this cycle of a run that was already going on. Before the first step of that run.
  void begin(std::uint64_t cycle) noexcept { begun_ = cycle; }

  /// No current sensor frame has come for loss_cycles periods (wall clock only): latches kCauseDriverLost from the next
  /// step on. No effect before the first step (a driver that was never there is missing, not lost) or while the
  /// driver's last frame reported that it is paused or has ended.
  void driver_lost() noexcept;

  /// The driver reported its end: it is missing until a new run.
  void driver_ended() noexcept;

  /// FrameFacts::kPersistence sensor frames in a row were corrupt: latches kCauseCorruptFrame from the next step on.
  void sensors_corrupt() noexcept;

  /// No frame comes, so nothing can be judged: a reset asked for meanwhile is answered with `why` and does not
  /// release anything later.
  void refuse_reset(const OperatorInput& operator_input, ResetRefusal why = kRefusalSilent) noexcept;

  /// No frame comes, but an emergency stop may: true when it did. It latches with the next step.
  bool note_emergency_stop(const OperatorInput& operator_input) noexcept;

  /// Fills everything but `out.head`. A second step in the same cycle counts nothing twice.
  void step(const MonitorInput& input, Permit& out) noexcept;

  /// The same before the first sensor frame: latches what came from outside, judges nothing.
  void step_without_sensors(const OperatorInput& operator_input, Permit& out) noexcept;

  /// Latched causes.
  std::uint64_t causes() const noexcept { return supervisor_.causes(); }

 private:
  void write(std::uint64_t cycle, std::uint64_t boot, Permit& out) const noexcept;
  void decide_restart(const SensorFrame& sensors) noexcept;
  void meet_driver(const SensorFrame& sensors) noexcept;
  void look(const MonitorInput& input) noexcept;
  void look_at_motion(const MonitorInput& input, std::uint64_t elapsed) noexcept;
  void add_pending() noexcept;
  void supervise(const MonitorInput& input, bool again) noexcept;
  double speed_limit(const OperatorInput& operator_input) const noexcept;

  double slow_speed_;
  Presence presence_;
  SensorPresence sensor_presence_;
  FrameFacts frame_facts_;
  OperatorFacts operator_facts_;
  Clearance clearance_;
  WheelMotion motion_;
  JointStandstill standstill_;
  Slide slide_;
  WheelTargets targets_;
  WheelLimits wheel_limits_;
  WheelFollowing wheel_following_;
  TorqueOscillation torque_oscillation_;
  YawAgreement yaw_agreement_;
  GateFacts gate_facts_;
  MachineFacts machine_facts_;
  BodyFacts body_facts_;
  ActiveCauses active_;  ///< of the last step
  Warnings warnings_;
  Evidence evidence_;
  Supervisor supervisor_;
  MotionRelease release_;
  std::optional<std::uint64_t> earlier_boot_;  ///< Permit::boot of an earlier monitor, until the first step
  std::optional<std::uint64_t> begun_;         ///< see `begin`, until the first step
  std::optional<std::uint64_t> cycle_;         ///< of the last step in this run
  double last_speed_limit_ = kNoSpeedLimit;
  std::uint64_t pending_ = 0;            ///< causes from outside a step
  std::optional<std::uint64_t> driver_;  ///< SensorFrame::boot of the last step
  bool driver_paused_ = false;
  std::uint64_t resets_handled_ = 0;
  std::uint64_t reset_refusal_ = 0;
};

}  // namespace robot_control
