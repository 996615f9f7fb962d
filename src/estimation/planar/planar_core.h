#pragma once
/// The pose in the plane: the gyro turns the robot, the wheels move it. No accelerometer enters.
///
///   ψ ← ψ + (1 + κ)(gyro − b) dt    (x, y) ← (x, y) + d (cos ψ̄, sin ψ̄)    d: distance of the middle of the wheels
///
/// ψ̄ is the yaw halfway between two readings, τ earlier: the stamps of the wheels are late by the clock offset τ.
/// Without gyro the wheels turn the robot. Once per block the wheels' turn is compared with the gyro's:
///
///   right − left = B (1 + β)(ψ − ψ₀ − τ (ω − ω₀)) − ε s    s = (left + right)/2, B: effective wheel base of the model
///
/// State: τ, x, y, ψ, ψ₀ (yaw at the beginning of the block), b, ε (radius_ratio − 1), β (wheel_base_factor − 1).
/// Considered and not corrected (S. F. Schmidt, 1966) are κ (gyro scale), which rolling does not distinguish from β;
/// the part of b's error that comes from a gyro noisier than its data sheet during rests: the wheels' errors, alike for
/// a while, would be taken for that; the mean radius of the wheels, which scales the path and
/// which no turn shows; and x_ICR, by how far ahead of the wheels' middle the robot turns, −x_ICR dψ
/// sideways, which wheels and gyro do not see. What the noise of such a gyro adds to the yaw enters ψ₀, too: no block
/// sees it. An innovation pulls no harder than Huber's bound; beyond kGate deviations it is not used. The walks of ε
/// and β are in proportion to the slip noise (wheel_noise.h).
///
/// Where wheels and gyro contradict each other, either may be wrong. The heading stays the gyro's, and
/// its deviation is what both have turned apart since the last rest, at its largest.
///
/// Before the first rest b looks like an ε, and that of wheels which a turn drags over the floor changes with load and
/// floor. Corrections of pose and b are held back, and P is that of a pose without them, until a rest or wheels that
/// are not dragged prove another b than the path was driven by. The first rest corrects the pose by ∂(x, y, ψ)/∂b
/// alone.
///
/// Until then ψ is wrong by a large δ, in which the covariance is linear. One cause bends the path, which is off by
/// (1 − cos δ) of its length along besides, √¾ σ_ψ² in the mean square: P_xy += q qᵀ, q = Σ min(1, √¾ σ_ψ²) (dx, dy).

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "estimation/planar/wheel_noise.h"
#include "estimation/tuning.h"
#include "estimation/values.h"
#include "signals/state_frame.h"

namespace robot_control {

struct PlanarPose {
  double x = 0, y = 0;  ///< m
  double yaw = 0;       ///< rad
};

struct PlanarCoreParams {
  double wheel_base = 0.5;                ///< m, effective
  double gyro_noise = 2.44e-4;            ///< rad/s/√Hz
  double gyro_bias_walk = 8.7e-6;         ///< rad/s/√s
  double gyro_bias_initial = 0.05;        ///< rad/s
  double gyro_scale = 5.8e-4;             ///< standard deviation
  double encoder = 4.4e-5;                ///< m, of one reading
  double slip_least = 8e-5;               ///< m/√m, of the best floor
  bool drags_wheels = true;               ///< in a turn, over the floor
  double ratio_deviation = 0.01;          ///< 0: held
  double wheel_base_deviation = 0.03;     ///< 0: held
  double radius_deviation = 0;            ///< of the wheels' mean radius, relative
  double icr_deviation = 0;               ///< m, of the instantaneous centre of rotation along x; 0: between two wheels
  double clock_offset = Tuning::kOffset;  ///< s, standard deviation; 0: held
};

class PlanarCore {
 public:
  enum Index : int { kOffset, kX, kY, kYaw, kAnchor, kBias, kRatio, kBase, kScale, kRestBias, kIcr, kRadius, kSize };
  static constexpr int kConsidered = 4;  ///< the last ones
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  struct Innovation {
    double nis = 0;
    bool used = false;
    double apart = 0;  ///< rad, by which the wheels turned more than the gyro
    double usual = 0;  ///< rad, kSignificant deviations of it
  };

  explicit PlanarCore(const PlanarCoreParams& params = {}) noexcept;

  void place(const PlanarPose& pose) noexcept;  ///< known exactly; all else stays
  void set_bias(double bias, double deviation) noexcept;
  /// What is held stays without deviation.
  void set_calibration(const WheelCalibration& known) noexcept;
  void set_pose_covariance(const Eigen::Matrix3d& known) noexcept;  ///< of x, y, yaw

  void turn_by_gyro(double angle, double dt) noexcept;          ///< rad, bias included
  void turn_by_wheels(double left, double right) noexcept;      ///< m
  double wheel_turn(double left, double right) const noexcept;  ///< rad, by the calibration
  /// m, odom axes; while it turned at `rate` rad/s.
  void roll(double x, double y, double rate) noexcept;
  void shift(double x, double y, double variance) noexcept;  ///< m, m²
  void add_yaw_variance(double variance) noexcept { covariance_(kYaw, kYaw) += variance; }

  /// Until it is, corrections of pose and bias are held back, and the covariance covers them; those of clock offset and
  /// calibration are not.
  void set_bias_known(bool known) noexcept { bias_known_ = known; }
  bool bias_known() const noexcept { return bias_known_; }

  /// The travel of both sides is read: a block begins.
  void begin_block(double rate) noexcept;
  /// It ends, after `left` and `right` m in `dt` s. `rate` rad/s: the gyro's at either end. `jitter` s²: variance of
  /// the stamps of the wheels.
  Innovation end_block(double left, double right, double rate, double dt, double jitter = 0) noexcept;
  /// Wheels and gyro contradict each other by `angle` rad more, while the robot went `distance` m.
  void contradict(double angle, double distance) noexcept;
  /// Since the last rest, by more than kUnknownHeading.
  bool contradicted() const noexcept { return largest_apart_ > Tuning::kUnknownHeading; }
  void end_contradiction() noexcept { apart_ = largest_apart_ = 0; }  ///< The covariance stays.
  /// The gyro's mean at rest, rad/s. `keeps_pose`: it stays where it is.
  void rest(double mean, double variance, bool keeps_pose) noexcept;
  void set_gyro_noise(double density) noexcept { gyro_noise_ = density; }  ///< rad/s/√Hz, learned
  void age(double dt) noexcept { covariance_(kBias, kBias) += square(params_.gyro_bias_walk) * dt; }
  void open_bias(double variance) noexcept { covariance_(kBias, kBias) += variance; }

  PlanarPose pose() const noexcept { return {state_[kX], state_[kY], state_[kYaw]}; }
  double bias() const noexcept { return state_[kBias]; }                     ///< rad/s
  double ratio() const noexcept { return state_[kRatio]; }                   ///< ε
  double base() const noexcept { return state_[kBase]; }                     ///< β
  double offset() const noexcept { return state_[kOffset]; }                 ///< τ, s
  double turned() const noexcept { return state_[kYaw] - state_[kAnchor]; }  ///< rad, in this block
  double slip() const noexcept { return noise_.slip(); }                     ///< m/√m, learned
  WheelCalibration calibration() const noexcept {
    return {1 + ratio(), 1 + base(), deviation(kRatio), deviation(kBase)};
  }

  /// Of the state as it is given out: corrections that are held back included.
  Matrix covariance() const noexcept {
    Matrix all = covariance_ + held_ * held_.transpose();
    all.block<2, 2>(kX, kX) += second_order_ * second_order_.transpose();
    return all;
  }
  double covariance(int i, int k) const noexcept { return covariance_(i, k) + held_[i] * held_[k]; }
  double deviation(int i) const noexcept { return std::sqrt(std::max(0.0, covariance(i, i))); }
  double bias_variance() const noexcept { return own_bias_variance() + square(held_[kBias]); }  ///< (rad/s)²

 private:
  void add(int to, double factor, int from) noexcept;
  void forget(int first, int count) noexcept;
  void slide(double turned) noexcept;
  void correct(Vector gain, const Vector& ph, double s, double innovation) noexcept;
  void consider_rest(Vector gain, double variance) noexcept;
  void walk(double mean, double rolled, double dt) noexcept;
  bool bias_proven() const noexcept;
  double own_bias_variance() const noexcept {  ///< without what is held back
    return covariance_(kBias, kBias) + 2 * covariance_(kBias, kRestBias) + covariance_(kRestBias, kRestBias);
  }

  PlanarCoreParams params_;
  Vector state_ = Vector::Zero();
  Matrix covariance_ = Matrix::Zero();
  Vector held_ = Vector::Zero();                            ///< corrections that are held back
  Vector by_bias_ = Vector::Unit(kBias);                    ///< derivative of the pose by the bias that drove it
  Eigen::Vector2d second_order_ = Eigen::Vector2d::Zero();  ///< m: q
  WheelNoise noise_;
  double apart_ = 0;          ///< rad, by contradictions since the last rest
  double largest_apart_ = 0;  ///< rad, since then
  double anchor_rate_ = 0;    ///< rad/s, at the beginning of the block
  double gyro_noise_;         ///< rad/s/√Hz, learned
  bool bias_known_ = true;
};

}  // namespace robot_control
