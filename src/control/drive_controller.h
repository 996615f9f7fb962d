#pragma once
/// diff_drive_controller's chain in one step: request → limits → kinematics → wheel loops → torque.
///
/// Every joint is braked (JointMode::kBrake) when
///   - there is no live permit, it orders the brake, or its ramp is over;
///   - the sensors are not valid, not finite, for another number of joints, their cycle does not advance, or a wheel
///     angle jumped faster than kFastestWheel (the loops then start anew from the next sample);
///   - the robot holds: zero wish, zero limited twist and all wheels standing (standstill.h); straight after a brake
///     all wheels slower than kStandstillSpeed are enough. The driver's brake law keeps the position; the next
///     wish ≠ 0 ends it.
/// What was not asked for ramps with the emergency deceleration: a command that timed out or was refused, more than
/// one sender where that is forbidden, a ramp permit. Under a ramp permit the wish is zero; under a permit with a speed
/// limit the wish is scaled until no rim is faster, along the same curve. Joints that are not wheels are always braked.
///
/// While the wheels do not follow this controller (it brakes, or the gate reports that tick k−1 was braked) limiter
/// and wheel loops are seeded with the measured speed, cycle by cycle, so nothing jumps at release: the first torque
/// is unaccelerated, and the ramp starts once the gate has passed it. The integrators take over what the brake was
/// holding (the measured effort) while the wheels stand; while they still turn the brake's effort is no load, and the
/// integrators keep what they last knew.
///
/// Saturation keeps the curvature. Speed: the wish, and what a target that changed during a ramp makes of the way
/// there, are scaled until no wheel exceeds what kinematics.h lets it use of its joint's limit; without keep_curvature
/// that bends ramps beyond an acceleration limit, by 1.4 times at the worst. Torque: with effort_i = rest_i +
/// inertial_i of the last cycle, inertial_i what feed-forward gives for its acceleration, the limiter may use
///
///   part = used·min_i max(effort_limit_i − sign(inertial_i)·rest_i, 0)/|inertial_i|,   0.2 ≤ part ≤ 1
///
/// of the acceleration limits, where `used` is what it used in that cycle: every wheel slows down its ramp alike, and
/// no plan runs away from wheels that cannot follow. A ramp towards zero is never stretched: who cannot stop as planned
/// is for the safety monitor to see (not_stopping, runaway). So is who is held fast or pushed back: after five times
/// its ramp the target is the wished speed whatever the wheels do (stall, wrong_direction). `rest` holds what the
/// wheels lag behind, so wrong masses and slopes count, too.
///
/// A state frame that is missing, held or invalid does not stop the drive: the wheel loops need only the encoders.
/// Skipped cycles: dt = (k − k_previous)·period. After more than kCommandLife the driver has braked by itself.

#include <cstdint>
#include <optional>
#include <vector>

#include "control/command_watch.h"
#include "control/drive_controller_parameters.h"
#include "control/kinematics.h"
#include "control/limits/speed_limiter.h"
#include "control/standstill.h"
#include "control/wheel_loops/feed_forward.h"
#include "control/wheel_loops/wheel_loop.h"
#include "robot/robot_model.h"
#include "signals/command_frame.h"
#include "signals/drive_tuning.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// Everything that one cycle depends on. Null: not available in this cycle.
struct ControlInput {
  const SensorFrame* sensors = nullptr;  ///< never null
  const StateFrame* state = nullptr;
  const Permit* permit = nullptr;  ///< the newest unexpired one ≤ k-1
  VelocityCommand request;         ///< the inbox; a new message is one with a new count
};

/// rad/s that no wheel reaches (10⁴ rpm): a faster change of angle is an encoder's error.
inline constexpr double kFastestWheel = 1000;

class DriveController {
 public:
  /// `robot` as read_robot gives it: at least a wheel on either side, wheels[i].joint == i. `period` s.
  DriveController(const DriveControllerParameters& parameters, const RobotModel& robot, double period);

  /// A new run: forgets requests, those that the inbox holds now among them, and every state.
  /// `with_zero`: the run begins with a zero request (command_watch.h).
  void reset(const VelocityCommand& inbox = {}, bool with_zero = false) noexcept;

  /// Between two cycles: other limits, timeout and gains, from the next step on. Bumpless (wheel_loop.h); what exceeds
  /// a lowered limit returns to it as the limiter does. They outlast `reset`.
  void tune(const DriveTuning& tuning) noexcept;

  /// Fills everything but `out.head`.
  void step(const ControlInput& input, CommandFrame& out) noexcept;

 private:
  bool measure(const SensorFrame& sensors) noexcept;
  bool usable(const SensorFrame& sensors) const noexcept;
  bool track(const WheelValues& angle, const SensorFrame& sensors) noexcept;
  std::uint64_t permit_reasons(const Permit* permit, std::uint64_t cycle) const noexcept;
  std::uint64_t state_reasons(const StateFrame* state, std::uint64_t cycle) noexcept;
  PlanarTwist wish(const Permit* permit, CommandFrame& out) const noexcept;
  bool slow() const noexcept;
  void follow_measured(const SensorFrame& sensors) noexcept;
  double affordable_part(const PlanarTwist& limited, const WheelValues& feed_forward) const noexcept;
  void drive(const PlanarTwist& wish, const SensorFrame& sensors, CommandFrame& out) noexcept;

  double period_;
  std::uint64_t joint_count_;
  DriveKinematics kinematics_;
  FeedForward feed_forward_;
  CommandWatch watch_;
  SpeedLimiter limiter_;
  Standstill standstill_;
  std::vector<WheelLoop> loops_;             ///< one per wheel; its index is the joint's
  std::optional<std::uint64_t> last_cycle_;  ///< of the last usable sample
  std::optional<WheelValues> last_angle_;    ///< rad, of the sample before; none: the loops start anew
  double part_ = 1;                          ///< of the acceleration limits, that the wheels' torque allows
  double periods_ = 1;                       ///< between the last two usable samples
  bool driving_ = false;                     ///< the last command was not the brake
  bool holding_ = false;                     ///< kReasonHolding in the last cycle
  bool followed_ = false;                    ///< the torque before this sample was this controller's
  std::uint64_t state_cycle_ = 0;
  std::uint64_t permit_cycle_ = 0;
};

}  // namespace robot_control
