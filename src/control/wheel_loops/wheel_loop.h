#pragma once
/// One driven wheel: planned motion → torque. Feed-forward, PID on the tracked speed, clamp.
///
///   error    = velocity_plan(k−2) − velocity
///   integral = integral + ki·error·dt
///   effort   = feed_forward + kp·error + integral − kd·acceleration,   |effort| ≤ effort_limit
///
/// velocity, acceleration: of the tracking loop on the encoder angle. The torque of cycle k acts over
/// [t_k+1, t_k+2), so what was planned at k−2 is what an ideal wheel does at t_k: comparing with that plan, the
/// integrator has nothing to learn from a ramp that feed-forward drives perfectly.
///
/// The tracking loop is told what the wheel should do anyway and what the measured torque adds to it,
///   known acceleration over [t_k-1, t_k)
///     = acceleration_plan(k−2) + (effort_measured − feed_forward(k−2) − load)/model_inertia
/// with the constant load = integral at the last hand-over; under the brake, whose torque is no drive, it is 0. Without
/// that, the tracking loop's lag makes a lifted wheel unstable at any useful kp. Plan and torque need not be right: the
/// loop's residual finds the rest.
///
/// Anti-windup by conditional integration: the integrator stops while the clamped sum is pushed further out, be it
/// clamped here or by the gate, and |integral| ≤ effort_limit. Where ki = 0 nobody would take back what it holds from a
/// brake or from other gains: it fades within 0.1 s, the pace of derived gains. Bumpless: `carry` gives the integrator
/// the load that the brake was holding, so the first torque after a brake is the torque before it and a robot on a
/// slope does not sag.
///
/// Bumpless in other gains, too (`tune`): in their first cycle the integrator takes over what proportional and
/// derivative part give less than the old ones would, and the tracking loop's residual what the torque tells it less;
/// so the torque goes on from where it was, up to ki·error·dt, and so does the tracked speed.
///
/// Gains for 12 kg, 1 kHz, 20 Hz, as wheel_loop_gains.h derives them for that robot (wheel inertia J: lifted 0.005,
/// turning 0.045, straight 0.065 kg·m²):
///   model_inertia = 2·J_lifted = 0.01. Told only the encoder angle (model_inertia = ∞) the lifted wheel is stable up
///     to kp = 0.88. Told the torque, kp may reach kp·dt/model_inertia = 1, that is 10 N·m·s/rad, for *every* inertia
///     from 0.005 kg·m² up. Less than 2·J_lifted lowers that limit, more leaves the lifted wheel undamped.
///   kp = 2: kp·dt/model_inertia = 0.2, a fifth of the limit; loaded, J/kp = 33 ms.
///   ki = 20: kp/ki = 0.1 s, a third of the pace of kp; what friction leaves at the end of a ramp is 0.12 mm (0.27 with
///     ki = 10).
///   kd = 0: the tracking loop's acceleration adds lag, not damping.
/// Spectral radius (wheel_loop_stability.h) and gain margin, all gains scaled together:
///   lifted 0.990, turning 0.987, straight 0.990, payload doubled 0.995 (the slow integrator); margin 4.9 or more
///   the same gains at 500 Hz 2.3; at 250 Hz the lifted wheel is unstable (1.16)
///   the article's kp 20, ki 0.1, kd 0.5: 7.2 lifted or loaded; without the tracking loop's knowledge of the torque
///     1.35 and 1.06: unstable as torque gains either way.
/// 0 → 1 → 0 m/s at 1 m/s² on the rigid plant of the tests: exact without friction and encoder; with 4096 counts and
/// 0.02 N·m·s/rad of friction RMS 0.9 mm/s, overshoot 0.05 %; mass doubled RMS 9.5 mm/s, overshoot 2.8 %.

#include <array>
#include <optional>

#include "control/wheel_loops/tracking_loop.h"
#include "signals/joint.h"

namespace robot_control {

/// The tracking loop's idea of the wheel, as a multiple of the lifted wheel's inertia.
inline constexpr double kModelInertiaFactor = 2.0;

struct WheelLoopGains {
  double kp = 2.0;              ///< N·m·s/rad
  double ki = 20.0;             ///< N·m/rad
  double kd = 0.0;              ///< N·m·s²/rad
  double model_inertia = 0.01;  ///< kg·m²; infinity: the tracking loop is not told the torque
};

/// What the wheel shall do in one cycle.
struct WheelPlan {
  double velocity = 0;      ///< rad/s
  double acceleration = 0;  ///< rad/s²
  double feed_forward = 0;  ///< N·m
};

/// All in the joint's own sign. Order in a cycle: `measure`; `resume`, perhaps `carry`, while the wheel does not
/// follow this loop; `step` where it shall be driven, in the cycle of the hand-over after `resume`.
class WheelLoop {
 public:
  /// `bandwidth` Hz of the tracking loop, `effort_limit` N·m, `period` s.
  WheelLoop(const WheelLoopGains& gains, double bandwidth, double effort_limit, double period);

  /// A new run: the next sample seeds the tracking loop.
  void reset() noexcept;

  /// Between two cycles: other gains and bandwidth, Hz. `feed_forward_less`, N·m: by so much less will the plan's
  /// feed-forward be than before.
  void tune(const WheelLoopGains& gains, double bandwidth, double feed_forward_less) noexcept;

  /// The next sample seeds the tracking loop; the integrator keeps the load.
  void lose_track() noexcept { tracked_ = false; }

  /// The sample of this cycle, `periods` ≥ 1 after the last one. Finite. `driven`: the torque since was this loop's.
  void measure(const JointSample& sample, double periods, bool driven) noexcept;

  /// The wheel does not follow this loop: whatever was planned is forgotten, the plan is the measured speed.
  void resume() noexcept;

  /// The next torque of an unaccelerated plan shall be `effort`, N·m.
  void carry(double effort) noexcept;

  /// N·m. `clamped`: the gate took something away from the last torque.
  double step(const WheelPlan& plan, double periods, bool clamped = false) noexcept;

  double velocity() const noexcept { return tracking_.velocity(); }  ///< rad/s
  double integral() const noexcept { return integral_; }             ///< N·m
  bool saturated() const noexcept { return saturated_; }             ///< the last step was clamped
  double wanted() const noexcept { return wanted_; }                 ///< N·m, of the last step, before the clamp
  double effort_limit() const noexcept { return effort_limit_; }     ///< N·m

 private:
  WheelLoopGains gains_;
  double effort_limit_;
  double period_;
  TrackingLoop tracking_;
  std::array<WheelPlan, 2> plans_{};  ///< of the last cycle and the one before
  double integral_ = 0;
  double wanted_ = 0;                         ///< N·m, the last effort before the clamp
  double load_ = 0;                           ///< N·m, integral at the last hand-over
  double surprise_ = 0;                       ///< N·m, what the measured torque told the tracking loop last
  std::optional<WheelLoopGains> last_gains_;  ///< those of the last step, where others hold since
  bool tracked_ = false;
  bool saturated_ = false;
};

}  // namespace robot_control
