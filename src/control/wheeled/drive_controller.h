#pragma once
/// The drive controller computes one cycle: request → limits → kinematics → wheel loops →
/// torque.
///
/// Every joint is braked (JointMode::kBrake) in these cases:
///   - there is no unexpired permit, or it orders the brake, or its ramp has ended;
///   - the sensors are unusable: not valid, not finite, for another number of joints, or of a cycle that does not
///     advance;
///   - a wheel angle jumped faster than kFastestWheel; the wheel loops then restart from the next sample;
///   - the robot holds: the requested twist is zero, the stop has ended, and the driver's brake law keeps the position
///     until the next requested twist ≠ 0. Directly after a brake, wheels slower than kStandstillSpeed are enough.
/// Joints that are not wheels are always braked.
///
/// A stop is planned by the limiter. It has ended when limited twist and lead are zero and all wheels stand
/// (standstill.h). It also ends in the brake if the wheels do not get there:
///   - kRestTime after the end of the plan;
///   - when the rims of a side are off the plan by max(kStopWay, v·kStopTime), v their speed before the stop, or have
///     moved kRestWay off it since its end.
/// So a load that slow wheel loops do not find, as on a slope at 20 Hz, does not move the robot for long. Drives that
/// close their own loops lag behind a ramp, so the way off the plan does not count for them.
///
/// A stop that was not requested ramps with the emergency deceleration. This applies after a command that timed out or
/// was refused, with more than one sender if that is forbidden, and under a ramp permit. A ramp permit sets the
/// requested twist to zero. A permit with a speed limit scales the requested twist, with the same curvature, until no
/// rim is faster.
///
/// The controller is not in control while it brakes, or if the gate reports that tick k−1 was braked. Then limiter and
/// wheel loops are set to the measured speed in every cycle, so that nothing jumps at release. While the wheels stand,
/// that speed is zero. The first torque is that of an unaccelerated motion, and the ramp starts once the gate has
/// passed it. If treads scrub and the wheels are slow, the limiter starts from rest.
///
/// While the wheels stand, the integrators are preloaded with the load that the brake holds. It is the mean of the
/// measured effort over about the last kStandstillTime of standstill without control. One sample is not enough, because
/// a robot rocks on its brakes after a hard stop, and a wrong preload would move it at release. While the wheels turn,
/// the effort of the brake is not a load, and the integrators keep their values.
///
/// Saturation keeps the curvature. The requested twist is scaled until no wheel exceeds the share of its velocity limit
/// that kinematics.h allows. The limited twist is scaled in the same way, because a target that changes during a ramp
/// may lead past that limit. Without keep_curvature this may exceed an acceleration limit by a factor of up to 1.4.
///
/// The effort of the last cycle is effort_i = rest_i + inertial_i; inertial_i is the feed-forward for the acceleration.
/// The limiter may use the acceleration limits times
///
///   scale = used·min_i max(effort_limit_i − sign(inertial_i)·rest_i, 0)/|inertial_i|,   0.2 ≤ scale ≤ 1
///
/// `used` is the scale of that cycle. So all wheels slow down their ramps alike, and no plan runs ahead of wheels that
/// cannot follow. `rest` contains the torque of the loops for lagging wheels, so wrong masses and slopes are included.
/// A ramp towards zero is never stretched: the safety monitor detects a robot that cannot stop as planned
/// (not_stopping, runaway). After five times its ramp time the target is the requested speed. So the monitor also
/// detects a robot that is blocked or pushed back (stall, wrong_direction).
///
/// With robot.wheel_command `velocity` the drives close the wheel loops (JointMode::kDriveVelocity). The command holds
/// the planned speed and the feed-forward torque. For drives that do not take it (kTakesEffort) the speed leads the
/// plan (wheel_loops/speed_lead.h). The loops have no gains then: they measure the speeds, without the torque. Nothing
/// is preloaded or learnt. The scale of the acceleration limits follows the lag λ_i = q̇*_i − q̇_i of the wheels, in the
/// direction of the acceleration a_i that the plan has without the scale:
///
///   scale = 2 − max_i λ_i/(3 T |a_i|),   0.2 ≤ scale ≤ 1        T: robot.wheel_response_time
///
/// The wheel loops use the encoders only. A state frame of an older cycle or one marked invalid does not stop the
/// drive. A cycle without any state frame does, because state frames wake the controller. The gate then holds the last
/// command for up to 3 missed cycles and brakes. After skipped cycles dt = (k − k_previous)·period. After more than
/// kCommandLife cycles the driver has already braked.

#include <cstdint>
#include <optional>

#include "control/common/command_watch.h"
#include "control/common/control_input.h"
#include "control/wheeled/drive_controller_parameters.h"
#include "control/wheeled/kinematics.h"
#include "control/wheeled/limits/speed_limiter.h"
#include "control/wheeled/standstill.h"
#include "control/wheeled/wheel_loops/feed_forward.h"
#include "control/wheeled/wheel_loops/ground_friction.h"
#include "control/wheeled/wheel_loops/speed_lead.h"
#include "control/wheeled/wheel_loops/wheel_loop.h"
#include "machine/wheeled/drive_train.h"
#include "signals/command_frame.h"
#include "signals/fixed_vector.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/velocity_command.h"
#include "signals/wheeled/drive_tuning.h"

namespace robot_control {

/// No wheel reaches this speed, in rad/s (10⁴ rpm): a faster change of angle is an encoder error.
inline constexpr double kFastestWheel = 1000;

inline constexpr double kStopWay = 0.1;  ///< m
// A robot of twice its mass leaves its plan by v·0.08 s at 200 Hz.
inline constexpr double kStopTime = 0.2;  ///< s
inline constexpr double kRestWay = 0.02;  ///< m; at 20 Hz a wheel turns on by 0.01 m
inline constexpr double kRestTime = 0.5;  ///< s; twice kStandstillTime

using WheelLoops = FixedVector<WheelLoop, kMaxWheels>;
using SpeedLeads = FixedVector<SpeedLead, kMaxWheels>;

class DriveController {
 public:
  static constexpr std::uint64_t kExecutable = kPartLinearX | kPartAngularZ;  ///< of RequestPart

  /// `robot` is a model from read_drive_train: at least one wheel on either side, and wheels[i].joint == i. `period` is
  /// in s.
  DriveController(const DriveControllerParameters& parameters, const DriveTrain& robot, double period);

  /// Begins a new run: all state is as at the start, and requests in the inbox do not count. With `with_zero` the run
  /// begins with a zero request (command_watch.h).
  void enter_run(const VelocityCommand& inbox = {}, bool with_zero = false) noexcept;

  /// Sets limits, timeout and gains between two cycles, from the next step on. The change is bumpless (wheel_loop.h).
  /// Speeds above a lowered limit return to it as the limiter does. The values stay after `enter_run`.
  void tune(const DriveTuning& tuning) noexcept;

  /// Returns the values in use: derived from the parameters, or set by `tune`.
  const DriveTuning& tuning() const noexcept { return tuning_; }

  /// Fills everything but `out.head` and the joints behind those of the robot, which stay as they are.
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
  PlanarTwist measured_twist() const noexcept;  ///< twist by the wheels' speeds
  void follow_measured(const SensorFrame& sensors) noexcept;
  double affordable_acceleration_scale(const PlanarTwist& limited, const WheelValues& feed_forward) const noexcept;
  double followable_acceleration_scale(const WheelValues& velocity, const WheelValues& acceleration) const noexcept;
  bool drives_close_loops() const noexcept { return mode_ == JointMode::kDriveVelocity; }
  WheelValues planned_efforts(const PlanarTwist& twist, const PlanarTwist& acceleration) noexcept;
  void search_ground_friction(const PlanarTwist& twist) noexcept;
  void learn_ground_friction() noexcept;
  double faster_rim(const PlanarTwist& twist) const noexcept;  ///< m/s, or m of a way
  /// Returns whether the brake has to end the stop; `stops`: the requested twist is zero.
  bool leaves_stop(bool stops, bool planned_rest) noexcept;
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
  WheelLoops loops_;                         ///< one per wheel, with the index of its joint
  SpeedLeads leads_;                         ///< likewise
  JointMode mode_;                           ///< of the commands of driven wheels
  double usual_lag_;                         ///< s, by which wheels with a speed loop of their own may follow a plan
  std::optional<std::uint64_t> last_cycle_;  ///< cycle of the last usable sample
  std::optional<WheelValues> last_angle_;    ///< rad, in the sample before; none: the loops restart
  WheelValues held_effort_{};                ///< N·m, mean since `held_cycles_`
  std::uint64_t held_cycles_ = 0;  ///< cycles in which the wheels stood and this controller was not in control
  double acceleration_scale_ = 1;  ///< share of the acceleration limits that the wheels' torque allows
  double stop_way_ = kStopWay;     ///< m, by which the next stop may leave its plan
  double rest_time_ = 0;           ///< s, since the plan of a stop ended
  double periods_ = 1;             ///< between the last two usable samples
  bool driving_ = false;           ///< The last command was not the brake.
  bool holding_ = false;           ///< kReasonHolding in the last cycle
  bool in_control_ = false;        ///< The torque before this sample came from this controller.
  std::uint64_t state_cycle_ = 0;
  std::uint64_t permit_cycle_ = 0;
};

}  // namespace robot_control
