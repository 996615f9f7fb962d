#pragma once
/// One driven wheel: planned motion → torque. Feed-forward, PID on the tracked speed, clamp.
///
///   error    = velocity_plan(k−2) − velocity
///   integral = integral + ki·(error − excused)·dt
///   effort   = feed_forward + hand_over + kp·error + integral − kd·acceleration,   |effort| ≤ effort_limit
///
/// velocity, acceleration: of the tracking loop on the encoder angle. The torque of cycle k acts over [t_k+1, t_k+2),
/// so at t_k an ideal wheel has the speed that was planned at k−2. Compared with that plan, a ramp that feed-forward
/// drives exactly leaves no error for the integrator.
///
/// The tracking loop receives the planned acceleration, and the acceleration that follows from the measured torque:
///   known acceleration over [t_k-1, t_k)
///     = acceleration_plan(k−2) + (effort_measured − feed_forward(k−2) − load)/model_inertia
/// with the constant load = integral at the last hand-over; under the brake, whose torque is not this loop's, the known
/// acceleration is 0, and what followed from the torque before goes to the residual, which had to cancel it wherever
/// load or integral have changed since the hand-over. Without it the lag of the tracking loop makes a lifted wheel
/// unstable at every useful kp. Plan and torque need not be exact: the loop's residual estimates the rest.
///
/// Anti-windup: a torque that a clamp takes, of this loop or of the gate, leaves an error that the integrator must not
/// see, because it would have to unwind again. `excused` is a model of that error:
///
///   taken    = effort before the clamp − effort after it, and, while the gate clamps, effort(k−2) − effort_measured
///   excused' = ki/kp·(taken/kp − excused), between 0 and error
///
/// For derived gains such an error decays with kp/J = 3·ki/kp (wheel_loop_gains.h). So a robot up to three times as
/// heavy as described leaves no error above `excused`. In cycles in which torque towards the plan is taken the integral
/// stands: a blocked wheel is no load. |integral| ≤ effort_limit.
///
/// With ki = 0 a preloaded integrator would never change: it decays with 0.1 s, the pace of derived gains. Bumpless:
/// `preload_integrator` sets the integrator to the load that the brake was holding, so that a robot on a slope does not
/// sag.
///
/// Bumpless change of gains and feed-forward (`tune`): torque, up to ki·error·dt, and tracked speed continue without a
/// jump, and nothing remains of it when the present ramp has ended. A difference of feed-forward at constant speed is a
/// load that stays: the integrator takes it over. A difference of the part for the acceleration, and of the
/// proportional and derivative parts between old and new gains, is `hand_over`, a torque that decays with 0.1 s: an
/// integrator would keep it after the ramp, for 1/pace of the new gains. The first of them belongs to feed_forward(k)
/// in the known acceleration, the second does not: no planned acceleration follows from it. The residual of the
/// tracking loop takes over the change of the known acceleration.
///
/// Gains for 12 kg, 1 kHz, 20 Hz, as wheel_loop_gains.h derives them for that robot (wheel inertia J: lifted 0.005,
/// turning 0.045, straight 0.065 kg·m²; derivation and margins: docs/evidence/derivations.md):
///   model_inertia = 2·J_lifted = 0.01. With the encoder angle alone (model_inertia = ∞) the lifted wheel is stable up
///     to kp = 0.88. With the measured torque the limit of stability is kp·dt/model_inertia = 1, that is 10 N·m·s/rad,
///     for *every* inertia from 0.005 kg·m² up; damping (control_problems.h) limits kp earlier. Less than 2·J_lifted
///     lowers that limit, more leaves the lifted wheel undamped.
///   kp = 2: kp·dt/model_inertia = 0.2, a fifth of the limit; loaded, J/kp = 33 ms.
///   ki = 20: kp/ki = 0.1 s, a third of the pace of kp.
///   kd = 0: the acceleration of the tracking loop adds lag, not damping.

#include <array>
#include <optional>

#include "robot/encoders/tracking_loop.h"
#include "signals/joint.h"

namespace robot_control {

/// The wheel inertia that the tracking loop assumes, as a multiple of the lifted wheel's inertia.
inline constexpr double kModelInertiaFactor = 2.0;

struct WheelLoopGains {
  double kp = 2.0;              ///< N·m·s/rad
  double ki = 20.0;             ///< N·m/rad
  double kd = 0.0;              ///< N·m·s²/rad
  double model_inertia = 0.01;  ///< kg·m²; infinity: the tracking loop does not use the measured torque
};

/// The planned motion of the wheel in one cycle.
struct WheelPlan {
  double velocity = 0;      ///< rad/s
  double acceleration = 0;  ///< rad/s²
  double feed_forward = 0;  ///< N·m
};

/// Decrease of the feed-forward of the present plan by other parameters, N·m.
struct FeedForwardDecrease {
  double steady = 0;    ///< of the part for the speed
  double inertial = 0;  ///< of the part for the acceleration
};

/// All values in the joint's own sign. Order in a cycle: `measure`; while this loop is not in control,
/// `reset_to_measured` and, at standstill, `preload_integrator`; `step` if the wheel is to be driven, in the cycle of
/// the hand-over after `reset_to_measured`.
class WheelLoop {
 public:
  /// `bandwidth` Hz of the tracking loop, `effort_limit` N·m, `period` s.
  WheelLoop(const WheelLoopGains& gains, double bandwidth, double effort_limit, double period);

  /// A new run: the next sample initialises the tracking loop.
  void reset() noexcept;

  /// Between two cycles: other gains and bandwidth, Hz.
  void tune(const WheelLoopGains& gains, double bandwidth, const FeedForwardDecrease& decrease) noexcept;

  /// `part` of the integral, N·m, from now on comes with the feed-forward.
  void move_to_feed_forward(double part) noexcept;

  /// Until this wheel's angle changes for the first time, its encoder is taken for that of `other`.
  void assume_encoder_of(const WheelLoop& other) noexcept { tracking_.assume_encoder_of(other.tracking_); }

  /// The next sample initialises the tracking loop; the integrator keeps the load.
  void restart_tracking() noexcept { tracked_ = false; }

  /// The sample of this cycle, `periods` ≥ 1 after the last one. Finite. `driven`: the torque since then came from this
  /// loop.
  void measure(const JointSample& sample, double periods, bool driven) noexcept;

  /// This loop is not in control: the plan is replaced by the measured speed.
  void reset_to_measured() noexcept;

  /// Sets the integrator so that the next torque of an unaccelerated plan is `effort`, N·m.
  void preload_integrator(double effort) noexcept;

  /// N·m. `clamped`: the gate reduced the last torque.
  double step(const WheelPlan& plan, double periods, bool clamped = false) noexcept;

  double velocity() const noexcept { return tracking_.velocity(); }       ///< rad/s
  double integral() const noexcept { return integral_; }                  ///< N·m
  bool saturated() const noexcept { return saturated_; }                  ///< the last step was clamped
  double unclamped_effort() const noexcept { return unclamped_effort_; }  ///< N·m, of the last step, before the clamp
  double effort_limit() const noexcept { return effort_limit_; }          ///< N·m

 private:
  /// `direct` N·m: the effort without the integral. `dt` s.
  void integrate(double error, double direct, double dt, bool clamped) noexcept;

  WheelLoopGains gains_;
  double effort_limit_;
  double period_;
  TrackingLoop tracking_;
  std::array<WheelPlan, 2> plans_{};  ///< of the last cycle and the one before
  std::array<double, 2> efforts_{};   ///< N·m, of the last step and the one before
  double taken_effort_ = 0;           ///< N·m, ordered less measured torque of the last sample
  double excused_ = 0;                ///< rad/s
  double integral_ = 0;
  double planned_hand_over_ = 0;              ///< N·m, of the feed-forward's part for the acceleration
  double gain_hand_over_ = 0;                 ///< N·m, of the proportional and derivative parts
  double unclamped_effort_ = 0;               ///< N·m, the last effort before the clamp
  double load_ = 0;                           ///< N·m, integral at the last hand-over
  double effort_residual_ = 0;                ///< N·m, the last measured torque less the planned one
  std::optional<WheelLoopGains> last_gains_;  ///< those of the last step, if changed since then
  bool tracked_ = false;
  bool saturated_ = false;
};

}  // namespace robot_control
