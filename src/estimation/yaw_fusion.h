#pragma once
/// One yaw increment from two: the wheels' and the gyro's, weighted by their noise densities [rad²/s].
///
///   wheels   q_w = wheel_slip_noise² · s / wheel_base²           s: smoothed |left| + |right| speed, m/s
///   gyro     q_g = q_n + σ_b² · kBiasHorizon,   q_n = gyro_noise² + gyro_turn_noise² · |ω|
///   gain     K = q_w / (q_w + q_g)        turn = turn_wheels + K · (turn_gyro − turn_wheels)
///
/// s is smoothed over kSpeedSmoothing, so that K does not depend on in which cycle an encoder counts: weighting
/// the cycles between two counts by their own travel would lose most of a slow turn. At rest s → 0, K → 0: the
/// gyro's noise does not turn a standing robot. A bias error σ_b is not white; over the horizon between two
/// stops it weighs like the density above. Over skipped cycles gap_variance / dt is added to q_g and q_n.
///
/// Innovation: the difference of the two rates, smoothed, y, with variance
///   S = (q_w + q_n) / (2 · kSmoothing) + σ_b² + rate_floor²,       nis = y² / S
/// `confidence` = exp(−nis / 2): 1 where wheels and gyro agree, 0.01 at three standard deviations. Beyond those
/// it is slip: then q_w is at least 2 · kSmoothing · y², the density that explains y, so that the gyro leads and
/// the covariance grows.

namespace robot_control {

struct YawFusionParameters {
  double wheel_slip_noise = 0.02;   ///< m/√m per wheel
  double wheel_base = 0.5;          ///< m
  double gyro_noise = 1.0e-3;       ///< rad/s/√Hz
  double gyro_turn_noise = 1.0e-3;  ///< rad/√rad
  double rate_floor = 0.01;         ///< rad/s: differences below it mean nothing (encoder counts)
};

struct YawSources {
  double turn_wheels = 0;    ///< rad, over dt
  double turn_gyro = 0;      ///< rad, over dt, bias removed; meaningless without `gyro`
  double travel = 0;         ///< m, |left| + |right| over dt
  double dt = 0;             ///< s, > 0
  double bias_variance = 0;  ///< (rad/s)²
  double gap_variance = 0;   ///< rad², what the trapezoid may be wrong by over skipped cycles
  bool gyro = true;
  bool standing = false;  ///< known to stand: K = 0
};

class YawFusion {
 public:
  static constexpr double kSmoothing = 0.05;      ///< s, of the innovation
  static constexpr double kSpeedSmoothing = 0.5;  ///< s, long against the time between two counts
  static constexpr double kBiasHorizon = 10.0;    ///< s, a leg between two stops
  static constexpr double kSlipNis = 9.0;         ///< three standard deviations

  explicit YawFusion(const YawFusionParameters& parameters) noexcept : parameters_(parameters) {}

  void reset() noexcept;
  void step(const YawSources& sources) noexcept;

  double turn() const noexcept { return turn_; }                      ///< rad
  double gain() const noexcept { return gain_; }                      ///< K
  double wheel_variance() const noexcept { return wheel_variance_; }  ///< rad², of this turn_wheels
  double gyro_variance() const noexcept { return gyro_variance_; }    ///< rad², of this turn_gyro, bias apart
  double confidence() const noexcept;
  bool slip() const noexcept { return nis_ > kSlipNis; }

 private:
  YawFusionParameters parameters_;
  double speed_ = 0;       ///< m/s, smoothed
  double innovation_ = 0;  ///< rad/s, smoothed
  double nis_ = 0;
  double gain_ = 0;
  double turn_ = 0;
  double wheel_variance_ = 0;
  double gyro_variance_ = 0;
};

}  // namespace robot_control
