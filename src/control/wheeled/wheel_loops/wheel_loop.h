#pragma once
/// Converts the planned motion of one driven wheel to torque: feed-forward, PID on the tracked speed, clamp.
///
///   error    = velocity_plan(k−2) − velocity
///   integral = integral + ki·(error − excused)·dt
///   effort   = feed_forward + hand_over + kp·error + integral − kd·acceleration,   |effort| ≤ effort_limit
///
/// velocity and acceleration come from the tracking loop on the encoder angle. The torque of cycle k acts over [t_k+1,
/// t_k+2), so at t_k an ideal wheel has the speed that was planned at k−2. Compared with that plan, a ramp that
/// feed-forward drives exactly leaves no error for the integrator.
///
/// The tracking loop receives the planned acceleration and the one that follows from the measured torque:
///   known acceleration over [t_k-1, t_k)
///     = acceleration_plan(k−2) + (effort_measured − feed_forward(k−2) − load)/model_inertia
/// The constant load is the integral at the last hand-over. Under the brake the known acceleration is 0, because the
/// torque is not this loop's. The part that followed from the torque before then moves to the residual, which had to
/// cancel it. Without the measured torque the lag of the tracking loop makes a lifted wheel unstable at every useful
/// kp. Plan and torque need not be exact: the loop's residual estimates the rest.
///
/// Anti-windup: this loop or the gate may clamp the torque. The error that this leaves must not reach the integrator,
/// which would have to unwind again. `excused` is a model of that error:
///
///   taken    = effort before the clamp − effort after it, and, while the gate clamps, effort(k−2) − effort_measured
///   excused' = ki/kp·(taken/kp − excused), between 0 and error
///
/// For derived gains such an error decays with kp/J = 3·ki/kp (wheel_loop_gains.h). So a robot up to three times as
/// heavy as described leaves no error above `excused`. The integral stands in cycles in which torque towards the plan
/// is taken: a blocked wheel is no load. |integral| ≤ effort_limit.
///
/// With ki = 0 a preloaded integrator would never change, so it decays with 0.1 s, the pace of derived gains.
/// `preload_integrator` sets the integrator to the load that the brake was holding, so that a robot on a slope does not
/// sag.
///
/// `tune` changes gains and feed-forward without a jump of torque, up to ki·error·dt, or of tracked speed. The
/// integrator takes over a difference of feed-forward at constant speed, which is a load that stays. The torque
/// `hand_over` decays with 0.1 s. It takes over the difference of the feed-forward for the acceleration, and that of
/// the proportional and derivative parts. An integrator would keep it after the ramp. Only the first of them belongs to
/// feed_forward(k) in the known acceleration, because no planned acceleration follows from the second. The residual of
/// the tracking loop takes over the change of the known acceleration.
///
/// The following gains are those that wheel_loop_gains.h derives for 12 kg, 1 kHz and 20 Hz. The wheel inertia J is
/// 0.005 lifted, 0.045 turning and 0.065 kg·m² straight. Derivation and margins are in docs/evidence/derivations.md.
///   model_inertia = 2·J_lifted = 0.01. The limit of stability is kp·dt/model_inertia = 1, that is 10 N·m·s/rad.
///   kp = 2: kp·dt/model_inertia = 0.2, a fifth of the limit; loaded, J/kp = 33 ms.
///   ki = 20: kp/ki = 0.1 s, a third of the pace of kp.
///   kd = 0: the acceleration of the tracking loop adds lag, not damping.

#include <array>
#include <optional>

#include "machine/encoders/tracking_loop.h"
#include "signals/joint.h"

namespace robot_control {

/// The tracking loop assumes this multiple of the lifted wheel's inertia.
inline constexpr double kModelInertiaFactor = 2.0;

struct WheelLoopGains {
  double kp = 2.0;              ///< N·m·s/rad
  double ki = 20.0;             ///< N·m/rad
  double kd = 0.0;              ///< N·m·s²/rad
  double model_inertia = 0.01;  ///< kg·m²; infinity: the tracking loop does not use the measured torque
};

/// Describes the planned motion of the wheel in one cycle.
struct WheelPlan {
  double velocity = 0;      ///< rad/s
  double acceleration = 0;  ///< rad/s²
  double feed_forward = 0;  ///< N·m
};

/// Holds the decrease of the present plan's feed-forward after a change of parameters, in N·m.
struct FeedForwardDecrease {
  double steady = 0;    ///< part for the speed
  double inertial = 0;  ///< part for the acceleration
};

/// All values are in the joint's own sign. In each cycle `measure` is called first. While this loop is not in control,
/// `reset_to_measured` and, at standstill, `preload_integrator` follow. If the wheel is driven, `step` is last, also in
/// the cycle of the hand-over.
class WheelLoop {
 public:
  /// `bandwidth` (Hz) is that of the tracking loop, `effort_limit` is in N·m and `period` in s.
  WheelLoop(const WheelLoopGains& gains, double bandwidth, double effort_limit, double period);

  /// Begins a new run: the next sample initialises the tracking loop.
  void reset() noexcept;

  /// Sets other gains and bandwidth (Hz) between two cycles.
  void tune(const WheelLoopGains& gains, double bandwidth, const FeedForwardDecrease& decrease) noexcept;

  /// Moves `part` of the integral, N·m, to the feed-forward.
  void move_to_feed_forward(double part) noexcept;

  /// Uses the encoder of `other` as a model of this one until this wheel's angle changes for the first time.
  void assume_encoder_of(const WheelLoop& other) noexcept { tracking_.assume_encoder_of(other.tracking_); }

  /// Lets the next sample initialise the tracking loop; the integrator keeps the load.
  void restart_tracking() noexcept { tracked_ = false; }

  /// Measures the finite sample of this cycle, `periods` ≥ 1 after the last one. `driven` states that the torque since
  /// then came from this loop.
  void measure(const JointSample& sample, double periods, bool driven) noexcept;

  /// Sets the measured speed to 0: the angle has not changed under the brake, and what was tracked is noise.
  void stand() noexcept { tracking_.restart_from(tracking_.measured(), 0); }

  /// Replaces the plan by the measured speed while this loop is not in control.
  void reset_to_measured() noexcept;

  /// Sets the integrator so that the next torque of an unaccelerated plan is `effort`, N·m.
  void preload_integrator(double effort) noexcept;

  /// Returns the torque in N·m. `clamped` states that the gate reduced the last torque.
  double step(const WheelPlan& plan, double periods, bool clamped = false) noexcept;

  /// Counts `off_plan` from here.
  void expect_plan() noexcept { off_plan_ = 0; }

  double velocity() const noexcept { return tracking_.velocity(); }  ///< rad/s
  double off_plan() const noexcept { return off_plan_; }             ///< rad, turned less planned, while in control
  double integral() const noexcept { return integral_; }             ///< N·m
  bool saturated() const noexcept { return saturated_; }             ///< The last step was clamped.
  double unclamped_effort() const noexcept { return unclamped_effort_; }  ///< N·m, in the last step, before the clamp
  double effort_limit() const noexcept { return effort_limit_; }          ///< N·m

 private:
  /// `direct` (N·m) is the effort without the integral; `dt` is in s.
  void integrate(double error, double direct, double dt, bool clamped) noexcept;

  WheelLoopGains gains_;
  double effort_limit_;
  double period_;
  TrackingLoop tracking_;
  std::array<WheelPlan, 2> plans_{};  ///< plans of the last cycle and of the one before
  std::array<double, 2> efforts_{};   ///< N·m, in the last step and in the one before
  double taken_effort_ = 0;           ///< N·m, ordered minus measured torque of the last sample
  double excused_ = 0;                ///< rad/s
  double integral_ = 0;
  double off_plan_ = 0;                       ///< rad
  double planned_hand_over_ = 0;              ///< N·m, share of the feed-forward for the acceleration
  double gain_hand_over_ = 0;                 ///< N·m, share of the proportional and derivative parts
  double unclamped_effort_ = 0;               ///< N·m, the last effort before the clamp
  double load_ = 0;                           ///< N·m, integral at the last hand-over
  double effort_residual_ = 0;                ///< N·m, last measured torque minus the planned one
  std::optional<WheelLoopGains> last_gains_;  ///< gains of the last step, if they changed since then
  bool tracked_ = false;
  bool saturated_ = false;
};

}  // namespace robot_control
