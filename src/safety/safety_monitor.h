#pragma once
/// The law of safety_monitor: conditions of one cycle → permit of that cycle.
///
///   conditions ─► active causes, by reaction ─► Warnings: reported, may limit the speed    ─► Permit
///                 (ActiveCauses)            └─► Supervisor: latch, state table ─► action
///
///   presence.h, sensor_presence.h, frame_conditions.h    which input is missing or cannot be trusted
///   motion_release.h                                     was a zero velocity requested since the last start
///   operator_conditions.h, clearance.h                   what the operator commands
///   wheel_motion.h ─► wheel_limits.h, wheel_following.h, torque_oscillation.h, yaw_agreement.h, joint_standstill.h,
///                     slide.h                            how the wheels move, compared with limits and targets
///   gate_conditions.h, machine_conditions.h,
///   body_conditions.h                                    does the gate obey, does the driver report a fault, does the
///                                                        body tilt, fall or collide
///
/// Calls: after construction `restore` where an earlier permit or a latch file is there, and `enter_run` at the
/// start of every run; `begin` with the cycle of the first frame; `step` once per cycle with that cycle's sensors. In
/// between, what does not come from a sensor frame: `driver_lost`, `driver_ended`, `sensors_corrupt`,
/// `note_emergency_stop`, `refuse_reset` (runtime/cycles/monitor_cycle.h).
///
/// States: INIT until sensors, state and command of this run were each received once and motion is released
/// (motion_release.h). READY and DRIVE permit motion until a node is restarted or a cause latches a stop
/// (fixed_reactions.h, SafetyParameters); STOPPING permits a ramp at most, STOPPED and FAULT nothing:
/// supervisor_table.h. The permit of cycle k expires after cycle k + kPermitLife, so a monitor that makes no progress
/// permits no motion.
///
/// Driver lost: latched when no current sensor frame arrives (wall clock), and when a frame carries another
/// SensorFrame::driver_instance than the frame before it (any clock). A restarted driver therefore counts as lost,
/// however short the interruption was and whatever the driver reported last. A reset of the simulation keeps the driver
/// instance. A driver that reports its end (DriverState::kEnded) is missing, not lost: the state becomes INIT, or a
/// latched stop stays.
///
/// A latch outlives all processes: a restarted monitor restores the causes of the last permit in the channel, for any
/// driver instance, and those of latch_file. Only an accepted reset clears them.
///
/// Permit::withdrawals counts starts (motion_release.h), latched causes and the end of an earlier monitor: what was
/// requested before one of them moves nothing after it (bridge/inputs/motion_requests.h).
///
/// The speed limit of a permit is the smaller of slow_speed, while a cause with Reaction::kSlow is active and for
/// kWarningHold after it (warnings.h), and the limit that the clearance gives. A speed limit never latches.

#include <cstdint>
#include <optional>

#include "robot/robot_model.h"
#include "safety/conditions/body_conditions.h"
#include "safety/conditions/frame_conditions.h"
#include "safety/conditions/gate_conditions.h"
#include "safety/conditions/machine_conditions.h"
#include "safety/conditions/operator_conditions.h"
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
  /// `period` s. A condition without a limit is not evaluated: call derived_limits (derived_limits.h) first.
  /// Throws std::invalid_argument for parameters that parameter_check.h refuses.
  SafetyMonitor(const SafetyParameters& parameters, const RobotModel& robot, double period);

  /// A new run: counters and "was received" flags restart; latched causes stay. `operator_input` is the current inbox:
  /// heartbeats in it are dropped, resets are refused (kRefusalInit); emergency stops that were not yet processed are
  /// kept.
  void enter_run(const OperatorInput& operator_input) noexcept;

  /// After a restart of the monitor: `last` is the permit that the channel still holds. Its causes are latched at once,
  /// and an `e_stop` topic that was true counts as true until it sends false. kCauseMonitorRestarted is added at the
  /// first step if the driver instance that `last` was issued for still runs, and, with or without `restore`, if the
  /// gate has already used a permit of this run.
  void restore(const Permit& last) noexcept;

  /// Latches `causes` at once, as read from another record of an earlier stop (latch_file). Without a permit in the
  /// channel, an `e_stop` topic that was a cause counts as true until it sends false: whether it still was is unknown.
  void restore(std::uint64_t causes, std::uint64_t first_cause) noexcept;

  /// This monitor was started in this cycle of a run that was already going on. Before the first step of that run.
  void begin(std::uint64_t cycle) noexcept { first_cycle_ = cycle; }

  /// No current sensor frame has come for loss_cycles periods (wall clock only): latches kCauseDriverLost from the next
  /// step on. No effect before the first step (a driver that never ran is missing, not lost) or while the driver's last
  /// frame reported that it is paused or has ended.
  void driver_lost() noexcept;

  /// The driver reported its end: it is missing until a new run.
  void driver_ended() noexcept;

  /// FrameConditions::kPersistence sensor frames in a row were corrupt: latches kCauseCorruptFrame from the next step
  /// on.
  void sensors_corrupt() noexcept;

  /// While no sensor frame arrives no condition can be evaluated: a reset that is requested meanwhile is refused with
  /// `why`, and has no effect later.
  void refuse_reset(const OperatorInput& operator_input, ResetRefusal why = kRefusalSilent) noexcept;

  /// While no sensor frame arrives an emergency stop may still be requested. It latches with the next step. True: one
  /// that was not active yet.
  bool note_emergency_stop(const OperatorInput& operator_input) noexcept;

  /// Fills everything but `out.head`. A second step in the same cycle evaluates no condition and answers no reset; it
  /// only adds causes reported since.
  void step(const MonitorInput& input, Permit& out) noexcept;

  /// The same before the first sensor frame: latches pending causes, evaluates no condition.
  void step_without_sensors(const OperatorInput& operator_input, Permit& out) noexcept;

  /// After `restore`: the topic `e_stop` counts as true until its next message.
  bool e_stop_held() const noexcept { return operator_conditions_.e_stop_held(); }

  /// Latched causes.
  std::uint64_t causes() const noexcept { return supervisor_.causes(); }

 private:
  void write(std::uint64_t cycle, std::uint64_t driver_instance, Permit& out) const noexcept;
  void detect_monitor_restart(const SensorFrame& sensors) noexcept;
  void check_driver_instance(const SensorFrame& sensors) noexcept;
  void evaluate_conditions(const MonitorInput& input) noexcept;
  void evaluate_motion(const MonitorInput& input, std::uint64_t elapsed) noexcept;
  void add_pending() noexcept;
  void supervise(const MonitorInput& input, bool repeated) noexcept;
  double speed_limit(const OperatorInput& operator_input) const noexcept;

  double slow_speed_;
  Presence presence_;
  SensorPresence sensor_presence_;
  FrameConditions frame_conditions_;
  OperatorConditions operator_conditions_;
  Clearance clearance_;
  WheelMotion motion_;
  JointStandstill standstill_;
  Slide slide_;
  WheelTargets targets_;
  WheelLimits wheel_limits_;
  WheelFollowing wheel_following_;
  TorqueOscillation torque_oscillation_;
  YawAgreement yaw_agreement_;
  GateConditions gate_conditions_;
  MachineConditions machine_conditions_;
  BodyConditions body_conditions_;
  ActiveCauses active_;  ///< of the last step
  Warnings warnings_;
  Evidence evidence_;
  Supervisor supervisor_;
  MotionRelease release_;
  std::optional<std::uint64_t>
      earlier_driver_instance_;               ///< Permit::driver_instance of an earlier monitor, until the first step
  std::optional<std::uint64_t> first_cycle_;  ///< see `begin`, until the first step
  std::optional<std::uint64_t> cycle_;        ///< of the last step in this run
  double last_speed_limit_ = kNoSpeedLimit;
  std::uint64_t earlier_withdrawals_ = 0;  ///< those of an earlier monitor, and its end
  std::uint64_t pending_ = 0;              ///< causes that were reported between two steps
  std::optional<std::uint64_t> driver_;    ///< SensorFrame::driver_instance of the last step
  bool driver_silence_expected_ = false;
  std::uint64_t resets_handled_ = 0;
  std::uint64_t reset_refusal_ = 0;
};

}  // namespace robot_control
