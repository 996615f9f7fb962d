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
/// Error state: x, y, ψ, b, ε (radius_ratio − 1), β (wheel_base_factor − 1), κ (gyro scale), τ, ψ₀ (yaw at the
/// beginning of the block). Considered and not corrected (S. F. Schmidt, 1966) are κ, which rolling does not
/// distinguish from β; x_ICR, by how far ahead of the wheels' middle the robot turns, −x_ICR dψ sideways, which wheels
/// and gyro do not see; and what a gyro that is noisier than its data sheet adds to the error of a rest's bias and to
/// the yaw: the wheels' errors, alike for a while, would be taken for that. The innovation pulls no harder than Huber's
/// bound; beyond kGate deviations it is not used.
///
/// The slip noise, m/√m of either side, and that of turning, rad/√rad, are learned from the innovations, each by its
/// share of their variance: steps of its logarithm towards the level at which half of them are below the median of a
/// normal distribution (H. Robbins, S. Monro, A stochastic approximation method, 1951), from a pessimistic start. The
/// walks of ε and β are in proportion to the first.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

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
  double ratio_deviation = 0.01;          ///< 0: held
  double wheel_base_deviation = 0.03;     ///< 0: held
  double icr_deviation = 0;               ///< m, of the instantaneous centre of rotation along x; 0: between two wheels
  double clock_offset = Tuning::kOffset;  ///< s, standard deviation; 0: held
};

class PlanarCore {
 public:
  enum Index : std::size_t { kX, kY, kYaw, kBias, kRatio, kBase, kScale, kOffset, kAnchor, kRestBias, kIcr, kSize };
  using Covariance = std::array<std::array<double, kSize>, kSize>;
  using Row = std::array<double, kSize>;

  struct Innovation {
    double nis = 0;
    bool used = false;
  };

  PlanarCore() = default;
  explicit PlanarCore(const PlanarCoreParams& params) noexcept;

  void place(const PlanarPose& pose) noexcept;  ///< known exactly; all else stays
  void set_bias(double bias, double deviation) noexcept;
  /// What is held stays without deviation.
  void set_calibration(const WheelCalibration& known) noexcept;

  void turn_by_gyro(double angle, double dt) noexcept;          ///< rad, bias included
  void turn_by_wheels(double left, double right) noexcept;      ///< m
  double wheel_turn(double left, double right) const noexcept;  ///< rad, by the calibration
  /// m, odom axes; while it turned at `rate` rad/s.
  void roll(double x, double y, double rate) noexcept;
  void shift(double x, double y, double variance) noexcept;  ///< m, m²
  void add_yaw_variance(double variance) noexcept { covariance_[kYaw][kYaw] += variance; }
  void set_pose_covariance(const Eigen::Matrix3d& known) noexcept;  ///< of x, y, yaw

  /// While it holds, corrections of the blocks are kept apart and do not reach pose and calibration, unless the bias is
  /// proven: before the first rest a gyro's bias and wheels of two sizes look the same, and the plain odometry is the
  /// pose. Its covariance covers them.
  void hold_corrections(bool holds) noexcept {
    holds_ = holds;
    if (holds) bias_in_doubt_ = true;
    if (!holds) release();
  }
  /// The robot has not moved by the bias it began with: nothing of the path depends on it.
  void replace_bias() noexcept { bias_in_doubt_ = false; }

  /// The travel of both sides is read: a block begins.
  void begin_block(double rate) noexcept;
  /// It ends, after `left` and `right` m in `dt` s. `rate` rad/s: the gyro's at either end. `jitter` s²: variance of
  /// the stamps of the wheels.
  Innovation end_block(double left, double right, double rate, double dt, double jitter = 0) noexcept;
  /// The gyro's mean at rest, rad/s. `holds`: the pose stays where it is.
  void rest(double mean, double variance, bool holds) noexcept;
  void set_gyro_noise(double density) noexcept { gyro_noise_ = density; }  ///< rad/s/√Hz, learned
  void age(double dt) noexcept { covariance_[kBias][kBias] += square(params_.gyro_bias_walk) * dt; }
  void open_bias(double variance) noexcept { covariance_[kBias][kBias] += variance; }

  /// Of x, y, yaw and clock offset.
  Eigen::Matrix4d pose_and_offset_covariance() const noexcept;
  WheelCalibration calibration() const noexcept { return {1 + ratio_, 1 + base_, deviation(kRatio), deviation(kBase)}; }
  const PlanarPose& pose() const noexcept { return pose_; }
  /// Of the pose and what is learned as they are given out, corrections that are held back included.
  double covariance(std::size_t i, std::size_t k) const noexcept { return covariance_[i][k] + held_[i] * held_[k]; }
  double deviation(std::size_t i) const noexcept { return std::sqrt(std::max(0.0, covariance(i, i))); }
  double bias_variance() const noexcept {  ///< (rad/s)²
    return covariance(kBias, kBias) + 2 * covariance(kBias, kRestBias) + covariance(kRestBias, kRestBias);
  }
  double bias() const noexcept { return bias_; }                  ///< rad/s
  double ratio() const noexcept { return ratio_; }                ///< ε
  double base() const noexcept { return base_; }                  ///< β
  double offset() const noexcept { return offset_; }              ///< τ, s
  double slip() const noexcept { return slip_; }                  ///< m/√m, learned
  double turned() const noexcept { return pose_.yaw - anchor_; }  ///< rad, in this block

 private:
  void add(std::size_t to, double factor, std::size_t from) noexcept;
  void slide(double turned) noexcept;
  void correct(const Row& gain, const Row& ph, double s, double innovation) noexcept;
  void release() noexcept;
  bool bias_proven() const noexcept;
  void learn(double normalised, double slips, double twists) noexcept;

  PlanarCoreParams params_;
  PlanarPose pose_;
  double bias_ = 0, ratio_ = 0, base_ = 0, offset_ = 0;
  double anchor_ = 0;
  double anchor_rate_ = 0;  ///< rad/s
  double gyro_noise_ = 0;   ///< rad/s/√Hz, learned
  double slip_ = 0;
  double twist_ = 0;                               ///< rad/√rad, learned
  double last_ = 0, correlation_ = 0, power_ = 1;  // of the innovations
  Covariance covariance_{};
  Row held_{};  ///< corrections that are held back
  bool holds_ = false;
  bool bias_in_doubt_ = false;  ///< the path was driven by a bias that no rest has shown yet
};

}  // namespace robot_control
