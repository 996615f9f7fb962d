#pragma once
/// Position, velocity and acceleration of a joint from its encoder angle: a third-order tracking loop (PLL).
///
/// Per sample, with dt since the last one and the innovation e = position_measured − position⁻:
///
///   position⁻ = position + velocity·dt + (residual + known)·dt²/2     position = position⁻ + (1 − p³)·e
///   velocity⁻ = velocity + (residual + known)·dt                      velocity = velocity⁻ + 3/2·(1 − p)²·(1 + p)·e/dt
///   residual⁻ = residual                                              residual = residual⁻ + (1 − p)³·e/dt²
///
/// p = exp(−2π·bandwidth·dt). The error dynamics have the triple pole z = p, exactly and for every dt: critically
/// damped and stable at any rate (the critically damped, "fading memory" α-β-γ filter: Brookner, Tracking and
/// Kalman Filtering Made Easy, section 2.3). A continuous PLL discretised by Euler is not.
///
/// `known` is the part of the acceleration that the caller knows (0: the plain PLL), `residual` the part that the loop
/// estimates, and acceleration = known + residual.
///
/// Steady-state errors, w = 2π·bandwidth: constant position, velocity and acceleration 0. Constant jerk j:
/// j/w³ in position, 3·j/w² in velocity (both to first order in w·dt), for all jerk that is not in `known`.
/// One encoder count q moves the velocity by at most 3/2·(1 − p)²·(1 + p)·q/dt ≈ 3·w²·dt·q: at 20 Hz, 1 kHz and
/// 4096 counts 0.060 rad/s, where differencing jumps by 1.53 rad/s.

namespace robot_control {

class TrackingLoop {
 public:
  /// `bandwidth` > 0, Hz; `period` > 0, s.
  TrackingLoop(double bandwidth, double period);

  void restart_from(double position, double velocity) noexcept;

  /// Another bandwidth, Hz > 0, from the next sample on; the tracked state stays. `known_decrease`, rad/s²: decrease of
  /// the known acceleration; it is added to the residual.
  void tune(double bandwidth, double known_decrease) noexcept;

  /// The sample `periods` ≥ 1 periods after the last one.
  void step(double position_measured, double known_acceleration, double periods) noexcept;

  double position() const noexcept { return position_; }               ///< rad
  double velocity() const noexcept { return velocity_; }               ///< rad/s
  double acceleration() const noexcept { return known_ + residual_; }  ///< rad/s²

 private:
  double bandwidth_;
  double period_;
  double nominal_pole_;  ///< of one period
  double position_ = 0;
  double velocity_ = 0;
  double residual_ = 0;
  double known_ = 0;
};

}  // namespace robot_control
