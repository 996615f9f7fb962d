#pragma once
/// The planar core estimates the pose in the plane: the gyro turns the robot, and the wheels move it.
///
///   ψ ← ψ + (1 + κ)(gyro − b) dt    (x, y) ← (x, y) + d (cos ψ̄, sin ψ̄)    d: distance of the middle of the wheels
///
/// ψ̄ is the yaw halfway between two readings of the wheels, τ before their stamps: τ is the clock offset by which the
/// wheels are late. Without a gyro the wheels turn the robot. Once per block the turn of the wheels is compared with
/// that of the gyro:
///
///   right − left = B (1 + β)(ψ − ψ₀ − τ (ω − ω₀)) − ε s    s = (left + right)/2, B: effective wheel base of the model
///
/// The state is τ, x, y, ψ, ψ₀ (yaw at the beginning of the block), b (gyro bias), ε (radius_ratio − 1) and β
/// (wheel_base_factor − 1). Three further errors widen the covariance and are not corrected (S. F. Schmidt, 1966):
///
///   κ        scale of the gyro
///   x_ICR    centre of rotation ahead of the middle of the wheels: a turn dψ moves the middle by −x_ICR dψ sideways
///   radius   mean radius of the wheels, relative; it scales the path
///
/// An innovation counts with at most kHuber deviations. Beyond kGate deviations it is not used. ε and β walk in
/// proportion to the slip noise (wheel_noise.h). If wheels and gyro contradict each other, the heading follows the
/// gyro. Its deviation is the largest angle by which both have turned apart since the last rest.
///
/// Until the bias is known, corrections of pose and b are held back, and P is that of the uncorrected pose. The bias is
/// known after a rest, or once undragged wheels prove that b differs from the bias used so far. The first rest corrects
/// the pose by ∂(x, y, ψ)/∂b alone. The reasons are in docs/evidence/derivations.md.

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
  bool drags_wheels = true;               ///< A turn drags wheels over the floor.
  double ratio_deviation = 0.01;          ///< 0: held
  double wheel_base_deviation = 0.03;     ///< 0: held
  double radius_deviation = 0;            ///< relative, of the wheels' mean radius
  double icr_deviation = 0;               ///< m, of the instantaneous centre of rotation along x; 0: between two wheels
  double clock_offset = Tuning::kOffset;  ///< s, standard deviation; 0: held
};

class PlanarCore {
 public:
  enum Index : int { kOffset, kX, kY, kYaw, kAnchor, kBias, kRatio, kBase, kScale, kIcr, kRadius, kSize };
  static constexpr int kConsidered = 3;  ///< the last states, which are considered and not corrected
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  struct Innovation {
    double nis = 0;
    bool used = false;
    double apart = 0;  ///< rad by which the wheels turned more than the gyro
    double usual = 0;  ///< rad, kSignificant deviations of `apart`
  };

  explicit PlanarCore(const PlanarCoreParams& params = {}) noexcept;

  void place(const PlanarPose& pose) noexcept;  ///< The pose is known exactly; all else stays.
  void set_bias(double bias, double deviation) noexcept;
  /// A deviation of 0 in the parameters holds its value.
  void set_calibration(const WheelCalibration& known) noexcept;
  void set_pose_covariance(const Eigen::Matrix3d& known) noexcept;  ///< covariance of x, y, yaw

  void turn_by_gyro(double angle, double dt) noexcept;          ///< rad, bias included
  void turn_by_wheels(double left, double right) noexcept;      ///< m
  double wheel_turn(double left, double right) const noexcept;  ///< rad, by the calibration
  /// Moves the pose by x, y (m, odom axes) while the robot turns at `rate` rad/s.
  void roll(double x, double y, double rate) noexcept;
  void shift(double x, double y, double variance) noexcept;  ///< m, m²
  void add_yaw_variance(double variance) noexcept { (*covariance_)(kYaw, kYaw) += variance; }

  /// While the bias is unknown, corrections of pose and bias are held back, and the covariance includes them. Clock
  /// offset and calibration are corrected nevertheless.
  void set_bias_known(bool known) noexcept { bias_known_ = known; }
  bool bias_known() const noexcept { return bias_known_; }

  /// Begins a block when the travel of both sides has been read.
  void begin_block(double rate) noexcept;
  /// Ends the block after `left` and `right` m in `dt` s. `rate` (rad/s) is the gyro's at the end.
  Innovation end_block(double left, double right, double rate, double dt) noexcept;
  /// Adds a contradiction of wheels and gyro by `angle` rad, which arose while the robot travelled `distance` m.
  void contradict(double angle, double distance) noexcept;
  /// Returns true if the contradiction since the last rest exceeded kUnknownHeading.
  bool contradicted() const noexcept { return largest_apart_ > Tuning::kUnknownHeading; }
  void end_contradiction() noexcept { apart_ = largest_apart_ = 0; }  ///< The covariance stays.
  /// Measures the bias by the gyro's mean at rest, rad/s. With `keeps_pose` the pose is not corrected.
  void rest(double mean, double variance, bool keeps_pose) noexcept;
  void age(double dt) noexcept { (*covariance_)(kBias, kBias) += square(params_.gyro_bias_walk) * dt; }
  void open_bias(double variance) noexcept { (*covariance_)(kBias, kBias) += variance; }

  PlanarPose pose() const noexcept { return {(*state_)[kX], (*state_)[kY], (*state_)[kYaw]}; }
  double bias() const noexcept { return (*state_)[kBias]; }                        ///< rad/s
  double ratio() const noexcept { return (*state_)[kRatio]; }                      ///< ε
  double base() const noexcept { return (*state_)[kBase]; }                        ///< β
  double offset() const noexcept { return (*state_)[kOffset]; }                    ///< τ, s
  double turned() const noexcept { return (*state_)[kYaw] - (*state_)[kAnchor]; }  ///< rad, in this block
  double slip() const noexcept { return noise_.slip(); }                           ///< m/√m, learned
  WheelCalibration calibration() const noexcept {
    return {1 + ratio(), 1 + base(), deviation(kRatio), deviation(kBase)};
  }

  /// Covariance of the published state, including the corrections that are held back.
  Matrix covariance() const noexcept { return *covariance_ + *held_ * (*held_).transpose(); }
  double covariance(int i, int k) const noexcept { return (*covariance_)(i, k) + (*held_)[i] * (*held_)[k]; }
  double deviation(int i) const noexcept { return std::sqrt(std::max(0.0, covariance(i, i))); }
  double bias_variance() const noexcept { return covariance(kBias, kBias); }  ///< (rad/s)²

 private:
  void add(int to, double factor, int from) noexcept;
  void forget(int first, int count) noexcept;
  void slide(double turned) noexcept;
  void correct(Vector gain, const Vector& ph, double s, double innovation) noexcept;
  void walk(int i, double variance) noexcept {  ///< A held value has no variance and does not walk.
    if ((*covariance_)(i, i) > 0) (*covariance_)(i, i) += variance;
  }
  bool bias_proven() const noexcept;

  PlanarCoreParams params_;
  Stored<Vector> state_;
  Stored<Matrix> covariance_;
  Stored<Vector> held_;                          ///< corrections that are held back
  Stored<Vector> by_bias_{Vector::Unit(kBias)};  ///< derivative of the pose by the bias of its integration
  WheelNoise noise_;
  double apart_ = 0;          ///< rad, sum of the contradictions since the last rest
  double largest_apart_ = 0;  ///< rad, largest |apart_| since the last rest
  double anchor_rate_ = 0;    ///< rad/s, at the beginning of the block
  bool bias_known_ = true;
};

}  // namespace robot_control
