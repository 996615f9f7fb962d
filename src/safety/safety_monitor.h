#pragma once
/// The law of the monitor: conditions of one cycle → permit of that cycle.
///
///   conditions ─► active causes, by reaction ─► Warnings: reported, may limit the speed    ─► Permit
///                 (ActiveCauses)            └─► Supervisor: latch, state table ─► action
///
///   presence.h, sensor_presence.h, frame_conditions.h    which input is missing or cannot be trusted
///   motion_release.h                                     was a zero velocity requested since the last start
///   operator_conditions.h, clearance.h                   what the operator commands
///   wheel_motion.h ─► wheel_limits.h, wheel_following.h, torque_oscillation.h, yaw_agreement.h, joint_standstill.h,
///                     slide.h, rim_speed.h               how the wheels move, compared with limits and targets
///   gate_conditions.h, machine_conditions.h,
///   body_conditions.h                                    does the gate obey, does the driver report a fault, does the
///                                                        body tilt, fall or collide
///
/// One `step` is made per cycle with that cycle's sensor frame. A step without a frame is made when the driver is
/// silent and something else happened (SensorSilence, a corrupt frame, a request of the operator). It evaluates no
/// condition on sensors, refuses resets and latches emergency stops. An equal step after it latches nothing.
///
/// States: INIT until sensors, state and command of this run were each received once and motion is released
/// (motion_release.h). READY and DRIVE permit motion until a node is restarted or a cause latches a stop
/// (fixed_reactions.h, SafetyParameters); STOPPING permits a ramp at most, STOPPED and FAULT nothing:
/// supervisor_table.h. The permit of cycle k expires after cycle k + kPermitLife, so a monitor that makes no progress
/// permits no motion.
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

#include <cstdint>
#include <optional>

#include "machine/wheeled/drive_train.h"
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
#include "safety/measurements/rim_speed.h"
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
  SafetyMonitor(const SafetyParameters& parameters, const DriveTrain& robot, double period);

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
  void evaluate_motion(const MonitorInput& input, std::uint64_t elapsed) noexcept;
  void supervise(const MonitorInput& input) noexcept;
  void write(Permit& out) const noexcept;
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
  RimSpeed rim_speed_;
  BodyConditions body_conditions_;
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

}  // namespace robot_control
