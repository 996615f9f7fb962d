#pragma once
/// Position, velocity and acceleration of a joint from its encoder angle and the acceleration that its motor explains:
/// a third-order tracking loop (PLL) with a model of an encoder's counts.
///
/// Per sample, with dt since the last one and p = exp(−2π·f·dt):
///
///   position⁻ = position + velocity·dt + (residual + known)·dt²/2     position = position⁻ + (1 − p³)·e
///   velocity⁻ = velocity + (residual + known)·dt                      velocity = velocity⁻ + 3/2·(1 − p)²·(1 + p)·e/dt
///   residual⁻ = residual                                              residual = residual⁻ + (1 − p)³·e_acc/dt²
///
/// `known` is the part of the acceleration that the caller knows (0: the plain PLL), `residual` the part that the loop
/// estimates, and acceleration = known + residual.
///
/// An encoder count of angle q shows only that the true angle lies in the cell measured ± q/2, and that it lay
/// in the last cell one sample ago. [l, h]: the part of the cell that is reached from the last one with velocity⁻. So
///
///   e_out = the way from position⁻ to [l, h]; 0 inside     what contradicts the encoder
///   e_in  = from there to the middle of [l, h]             what the encoder does not know
///   e     = e_out + κ²·e_in,      e_acc = e_out·max(|e_out|/(|e_out| + q'/4), n)
///
///   f_in = min(bandwidth/5, |velocity|/q/40)      pace inside the cell: at most a fortieth of the rate of counts
///   f    = max(5·f_in, m·bandwidth·min(|e_out|/q', 1), n·bandwidth, bandwidth/10)   κ = f_in/f
///   q'   = q·min(1, q/(2π/512))                   by how much counts have to be contradicted: less of fine ones
///   n    = clamp(s/q − 1, 0, 1), s = |∫ velocity⁻ dt| since the last count: a wheel that should have shown one, and
///          did not, is held; without n, torque that grows against friction passes for a speed
///   m    = min(1, max(|velocity|, 1.5 rad/s)/(2π·bandwidth·q))     a count may change the velocity by 2π·f·q
///
/// While prediction and counts agree, as in every steady motion, counts hardly appear in the velocity; what contradicts
/// them by q' is corrected with the full bandwidth, less at speeds of few counts. Of an error of which the part λ
/// ≤ 1 lies beyond the cell, the part μ ≤ λ counts for the residual; with w = 2π·f the loop has s³ + a·s² + b·s + c, a
/// = 3·(λ + κ²)·w, b = 3·(λ + κ²)·w², c = μ·w³. It is stable, a·b > c, for every λ while κ² > 1/36, and with μ well
/// below λ, as for small errors, with less. κ is 1/5 down to 80 counts per 1/bandwidth. Position and velocity are
/// corrected by the same e, whose mean vanishes in steady motion: the velocity has no bias but by aliases of the counts
/// with the period, below 0.5 %.
///
/// An exact encoder, q = 0, has e = e_out and f = bandwidth: then the error dynamics have the triple pole z = p,
/// exactly and for every dt: critically damped and stable at any rate (the critically damped, "fading memory" α-β-γ
/// filter: Brookner, Tracking and Kalman Filtering Made Easy, section 2.3). A continuous PLL discretised by Euler is
/// not. Steady-state errors, w = 2π·bandwidth: constant position, velocity and acceleration 0. Constant jerk j: j/w³ in
/// position, 3·j/w² in velocity (both to first order in w·dt), for all jerk that is not in `known`.

#include "robot/encoders/encoder_quantum.h"

namespace robot_control {

class TrackingLoop {
 public:
  /// `bandwidth` > 0, Hz; `period` > 0, s.
  TrackingLoop(double bandwidth, double period);

  /// A new run: what was learned of the encoder is forgotten.
  void reset() noexcept;

  /// The loop of another wheel: its encoder counts for this one's, until this one's angle changes.
  void assume_encoder_of(const TrackingLoop& other) noexcept;

  /// What was learned of the encoder stays.
  void restart_from(double position, double velocity) noexcept;

  /// Another bandwidth, Hz > 0, from the next sample on; the tracked state stays.
  void tune(double bandwidth) noexcept;

  /// From the next sample on the caller knows `decrease` less of the acceleration, rad/s²; the residual has it.
  void know_less(double decrease) noexcept { residual_ += decrease; }

  /// The sample `periods` ≥ 1 periods after the last one.
  void step(double position_measured, double known_acceleration, double periods) noexcept;

  double position() const noexcept { return position_; }               ///< rad
  double velocity() const noexcept { return velocity_; }               ///< rad/s
  double acceleration() const noexcept { return known_ + residual_; }  ///< rad/s²
  double quantum() const noexcept { return quantum_.value(); }         ///< rad, of the encoder

 private:
  /// Of an innovation, rad: to rad, rad/s, rad/s².
  struct Gains {
    double position = 0;
    double velocity = 0;
    double residual = 0;
  };

  static Gains gains(double pole, double dt) noexcept;
  void derive() noexcept;  ///< what follows from bandwidth and quantum
  double part_of_bandwidth(double pace, double beyond, double silent) const noexcept;

  double bandwidth_;
  double period_;
  Gains nominal_;       ///< of bandwidth and one period
  double doubt_ = 0;    ///< rad, q'
  double slowest_ = 0;  ///< rad/s, from which on f_in is bandwidth/5
  EncoderQuantum quantum_;
  double measured_ = 0;   ///< rad, the last sample
  double travelled_ = 0;  ///< rad, predicted since the angle changed
  double position_ = 0;
  double velocity_ = 0;
  double residual_ = 0;
  double known_ = 0;
};

}  // namespace robot_control
