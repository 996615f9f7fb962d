#pragma once
/// One step of diff_drive_controller: request → limits → kinematics → wheel loops → torque.
///
/// Every joint is braked (JointMode::kBrake) when
///   - there is no unexpired permit, or it orders the brake, or its ramp has ended;
///   - the sensors are not valid, not finite, for another number of joints, their cycle does not advance, or a wheel
///     angle jumped faster than kFastestWheel (the wheel loops then restart from the next sample);
///   - the robot holds: requested twist and limited twist are zero and all wheels stand (standstill.h); directly after
///     a brake it is enough that all wheels are slower than kStandstillSpeed. The driver's brake law keeps the
///     position. The next requested twist ≠ 0 ends it.
/// A stop that was not requested ramps with the emergency deceleration: after a command that timed out or was refused,
/// with more than one sender if that is forbidden, and under a ramp permit. Under a ramp permit the requested twist is
/// zero. Under a permit with a speed limit it is scaled, with the same curvature, until no rim is faster. Joints that
/// are not wheels are always braked.
///
/// While this controller is not in control of the wheels (it brakes, or the gate reports that tick k−1 was braked),
/// limiter and wheel loops are set to the measured speed in every cycle, so that nothing jumps at release: the first
/// torque is that of an unaccelerated motion, and the ramp starts once the gate has passed it. A robot whose treads
/// scrub and whose wheels stand starts from rest. While the wheels stand, the integrators are preloaded with the load
/// that the brake holds: the mean of the measured effort over about the last kStandstillTime in which the wheels stood
/// and this controller was not in control. One sample would not do: a robot that was braked hard rocks on its brakes,
/// and with a wrong preload it moves by itself at release. While the wheels turn, the effort of the brake is not a
/// load, and the integrators keep their values.
///
/// Saturation keeps the curvature.
/// Speed: the requested twist is scaled until no wheel exceeds the part of its velocity limit that kinematics.h allows.
/// The limited twist is scaled in the same way, because a target that changes during a ramp may lead past that limit;
/// without keep_curvature this may exceed an acceleration limit by a factor of up to 1.4.
/// Torque: effort_i = rest_i + inertial_i of the last cycle, inertial_i what feed-forward adds for the acceleration.
/// The limiter may use the acceleration limits times
///
///   scale = used·min_i max(effort_limit_i − sign(inertial_i)·rest_i, 0)/|inertial_i|,   0.2 ≤ scale ≤ 1
///
/// `used`: the scale that it used in that cycle. So all wheels slow down their ramps alike, and no plan runs ahead of
/// wheels that cannot follow. `rest` contains the torque that the loops add when the wheels lag behind, so wrong masses
/// and slopes are included. A ramp towards zero is never stretched: a robot that cannot stop as planned is detected by
/// the safety monitor (not_stopping, runaway). So is a robot that is blocked or pushed back: after five times its ramp
/// time the target is the requested speed, whatever the wheels do (stall, wrong_direction).
///
/// The wheel loops use the encoders only: a state frame that is held (of an older cycle) or marked invalid does not
/// stop the drive. A cycle without any state frame does: state frames wake this controller, so it is not woken and
/// publishes no command; the gate holds the last command for up to 3 missed cycles and then brakes.
/// Skipped cycles: dt = (k − k_previous)·period. After more than kCommandLife cycles the driver has already braked.

#include <cstdint>
#include <optional>

#include "control/command_watch.h"
#include "control/drive_controller_parameters.h"
#include "control/kinematics.h"
#include "control/limits/speed_limiter.h"
#include "control/standstill.h"
#include "control/wheel_loops/feed_forward.h"
#include "control/wheel_loops/ground_friction.h"
#include "control/wheel_loops/wheel_loop.h"
#include "robot/robot_model.h"
#include "signals/command_frame.h"
#include "signals/drive_tuning.h"
#include "signals/fixed_vector.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// All inputs of one cycle. Null: not available in this cycle.
struct ControlInput {
  const SensorFrame* sensors = nullptr;  ///< never null
  const StateFrame* state = nullptr;
  const Permit* permit = nullptr;  ///< the newest unexpired one ≤ k-1
  VelocityCommand request;         ///< the inbox; a new message is one with a new count
};

/// rad/s, 10⁴ rpm, more than any wheel reaches: a faster change of angle is an encoder error.
inline constexpr double kFastestWheel = 1000;

using WheelLoops = FixedVector<WheelLoop, kMaxWheels>;

class DriveController {
 public:
  /// `robot` as read_robot gives it: at least a wheel on either side, wheels[i].joint == i. `period` s.
  DriveController(const DriveControllerParameters& parameters, const RobotModel& robot, double period);

  /// A new run: all state is as at the start; requests that the inbox holds now do not count.
  /// `with_zero`: the run begins with a zero request (command_watch.h).
  void enter_run(const VelocityCommand& inbox = {}, bool with_zero = false) noexcept;

  /// Between two cycles: other limits, timeout and gains, from the next step on. Bumpless (wheel_loop.h); speeds above
  /// a lowered limit return to it as the limiter does. The values stay after `enter_run`.
  void tune(const DriveTuning& tuning) noexcept;

  /// What it runs with: derived from the parameters, or the last that `tune` got.
  const DriveTuning& tuning() const noexcept { return tuning_; }

  /// Fills everything but `out.head`.
  void step(const ControlInput& input, CommandFrame& out) noexcept;

 private:
  bool measure(const SensorFrame& sensors) noexcept;
  bool usable(const SensorFrame& sensors) const noexcept;
  bool track(const WheelValues& angle, const SensorFrame& sensors) noexcept;
  std::uint64_t permit_reasons(const Permit* permit, std::uint64_t cycle) const noexcept;
  std::uint64_t state_reasons(const StateFrame* state, std::uint64_t cycle) noexcept;
  PlanarTwist permitted_twist(const Permit* permit, CommandFrame& out) const noexcept;
  bool slow() const noexcept;
  void average_held_efforts(const SensorFrame& sensors) noexcept;
  PlanarTwist measured_twist() const noexcept;  ///< of the wheels
  void follow_measured(const SensorFrame& sensors) noexcept;
  double affordable_acceleration_scale(const PlanarTwist& limited, const WheelValues& feed_forward) const noexcept;
  WheelValues planned_efforts(const PlanarTwist& twist, const PlanarTwist& acceleration) noexcept;
  void search_ground_friction(const PlanarTwist& twist) noexcept;
  void learn_ground_friction() noexcept;
  void drive(const PlanarTwist& requested, const SensorFrame& sensors, CommandFrame& out) noexcept;

  DriveTuning tuning_;
  double period_;
  std::uint64_t joint_count_;
  DriveKinematics kinematics_;
  FeedForward feed_forward_;
  GroundFriction ground_friction_;
  CommandWatch watch_;
  SpeedLimiter limiter_;
  Standstill standstill_;
  WheelLoops loops_;                         ///< one per wheel; its index is the joint's
  std::optional<std::uint64_t> last_cycle_;  ///< of the last usable sample
  std::optional<WheelValues> last_angle_;    ///< rad, of the sample before; none: the loops restart
  WheelValues held_effort_{};                ///< N·m, mean since `held_cycles_`
  std::uint64_t held_cycles_ = 0;            ///< in which the wheels stood and this controller was not in control
  double acceleration_scale_ = 1;            ///< of the acceleration limits, as the wheels' torque allows
  double periods_ = 1;                       ///< between the last two usable samples
  bool driving_ = false;                     ///< the last command was not the brake
  bool holding_ = false;                     ///< kReasonHolding in the last cycle
  bool in_control_ = false;                  ///< the torque before this sample came from this controller
  std::uint64_t state_cycle_ = 0;
  std::uint64_t permit_cycle_ = 0;
};

}  // namespace robot_control
