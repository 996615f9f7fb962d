#pragma once
/// Estimates position, velocity and acceleration of a joint from its encoder angle and the acceleration that its motor
/// explains. It is a third-order tracking loop (PLL) with a model of an encoder's counts.
///
/// For each sample, with dt since the last one and p = exp(−2π·f·dt):
///
///   position⁻ = position + velocity·dt + (residual + known)·dt²/2     position = position⁻ + (1 − p³)·e
///   velocity⁻ = velocity + (residual + known)·dt                      velocity = velocity⁻ + 3/2·(1 − p)²·(1 + p)·e/dt
///   residual⁻ = residual                                              residual = residual⁻ + (1 − p)³·e_acc/dt²
///
/// `known` is the part of the acceleration that the caller knows (0: the plain PLL), `residual` the part that the loop
/// estimates, and acceleration = known + residual.
///
/// An encoder with the count q shows only that the true angle lies in the cell measured ± q/2. It also lay in the last
/// cell one sample ago. The interval [l, h] is the part of the cell that is reached from the last one with velocity⁻:
///
///   e_out = distance from position⁻ to [l, h]; 0 inside    it contradicts the encoder
///   e_in  = from there to the middle of [l, h]             the encoder does not show it
///   e     = e_out + κ²·e_in,      e_acc = e_out·max(|e_out|/(|e_out| + q'/4), n)
///
///   f_in = min(bandwidth/5, |velocity|/q/40)      pace inside the cell: at most a fortieth of the rate of counts
///   f    = max(5·f_in, m·bandwidth·min(|e_out|/q', 1), n·bandwidth, bandwidth/10)   κ = f_in/f
///   q'   = q·min(1, q/(2π/512))                   contradiction that counts in full; it is smaller for fine counts
///   n    = clamp(s/q − 1, 0, 1), s = |∫ velocity⁻ dt| since the last count: a wheel without the expected count is held
///   m    = min(1, max(|velocity|, 1.5 rad/s)/(2π·bandwidth·q))     a count may change the velocity by 2π·f·q
///
/// While prediction and counts agree, as in every steady motion, counts hardly appear in the velocity. A contradiction
/// by q' is corrected with the full bandwidth, or less at speeds of few counts. Without n, torque that grows against
/// friction would appear as a speed. Position and velocity are corrected by the same e, whose mean vanishes in steady
/// motion. So the velocity has no bias except aliases of the counts with the period, below 0.5 %.
///
/// An exact encoder, q = 0, has e = e_out and f = bandwidth. The error dynamics then have the triple pole z = p for
/// every dt: they are critically damped and stable at any rate (fading-memory α-β-γ filter; Brookner, Tracking and
/// Kalman Filtering Made Easy, section 2.3). Steady-state errors vanish for constant position, velocity and
/// acceleration. Constant jerk j that is not in `known` leaves j/w³ in position and 3·j/w² in velocity, w =
/// 2π·bandwidth, to first order in w·dt. docs/evidence/derivations.md shows the stability.

#include <numbers>

namespace robot_control {

/// Learns the angle of one encoder count from the samples. It is the smallest step of the angle, or change of step, so
/// far.
///
/// A wheel that starts, or changes its speed, shows a single count at once. The steps of an encoder without counts
/// change by less and less. Below 10⁻⁴ rad, 63,000 counts a turn, it counts as exact: 0. Until the angle changes for
/// the first time, the count is that of another wheel whose angle has changed. Otherwise it is that of the coarsest
/// known encoder: 45 counts a turn, of a hub motor's Hall sensors.
class EncoderQuantum {
 public:
  /// Learns from the angle `turned` since the last sample, rad. Returns true if the value has changed.
  bool refine(double turned) noexcept;

  /// Takes the value of another wheel until the angle changes for the first time. Returns true if the value has
  /// changed.
  bool assume(const EncoderQuantum& other) noexcept;

  double value() const noexcept { return value_; }  ///< rad; 0: exact

 private:
  static constexpr double kCoarsest = 2 * std::numbers::pi / 45;  // rad

  double value_ = kCoarsest;
  double last_ = 0;       ///< rad, last step
  bool changed_ = false;  ///< The angle has changed at least once.
};

class TrackingLoop {
 public:
  /// `bandwidth` is in Hz and `period` in s; both are > 0.
  TrackingLoop(double bandwidth, double period);

  /// Begins a new run and forgets the encoder's count.
  void reset() noexcept;

  /// Uses the encoder's count of another wheel until this one's angle changes.
  void assume_encoder_of(const TrackingLoop& other) noexcept {
    if (quantum_.assume(other.quantum_)) derive();
  }

  /// Restarts from this state; the encoder's count stays.
  void restart_from(double position, double velocity) noexcept;

  /// Sets another bandwidth, Hz > 0, from the next sample on; the tracked state stays.
  void tune(double bandwidth) noexcept;

  /// Moves `decrease` (rad/s²) from the known acceleration of the next samples to the residual.
  void know_less(double decrease) noexcept { residual_ += decrease; }

  /// Takes the sample `periods` ≥ 1 periods after the last one.
  void step(double position_measured, double known_acceleration, double periods) noexcept;

  double measured() const noexcept { return measured_; }               ///< rad, the last sample
  double position() const noexcept { return position_; }               ///< rad
  double velocity() const noexcept { return velocity_; }               ///< rad/s
  double acceleration() const noexcept { return known_ + residual_; }  ///< rad/s²
  double quantum() const noexcept { return quantum_.value(); }         ///< rad, count of the encoder

 private:
  /// Holds the gains from an innovation in rad to rad, rad/s and rad/s².
  struct Gains {
    double position = 0;
    double velocity = 0;
    double residual = 0;
  };

  static Gains gains(double pole, double dt) noexcept;
  void derive() noexcept;  ///< derives the values that follow from bandwidth and quantum
  double part_of_bandwidth(double pace, double beyond, double silent) const noexcept;

  double bandwidth_;
  double period_;
  Gains nominal_;           ///< for the bandwidth and one period
  double uncertainty_ = 0;  ///< rad, q'
  double slowest_ = 0;      ///< rad/s above which f_in is bandwidth/5
  EncoderQuantum quantum_;
  double measured_ = 0;   ///< rad, last sample
  double travelled_ = 0;  ///< rad, predicted since the angle changed
  double position_ = 0;
  double velocity_ = 0;
  double residual_ = 0;
  double known_ = 0;
};

}  // namespace robot_control
