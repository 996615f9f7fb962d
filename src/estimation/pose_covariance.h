#pragma once
/// Covariance of the errors of (x, y, yaw, gyro bias), x and y in odom axes.
///
///   step      P ← F P Fᵀ + G Q Gᵀ
///             δx ← δx − Δy·δyaw + ∂x/∂d·δd + ∂x/∂t·δt,   δy alike with +Δx,   δyaw ← δyaw + δt
///             δt = (1 − K)·δt_wheels + K·(δt_gyro − dt·δb)     (Δx, Δy) the chord, K the gain of the fusion
///             Q: var(d) = wheel_base²/4 · var(t_wheels), uncorrelated with t for wheels of equal travel
///   time      var(b) ← var(b) + gyro_bias_walk² · dt
///   standing  gain k = var(b) / (var(b) + R); b is corrected, the pose is not (a consider update):
///             var(b) ← (1 − k)² var(b) + k² R,   cov(·, b) ← (1 − k) cov(·, b)
///
/// The bias is in the state because its error is the same for a whole leg: yaw errors from it grow with time,
/// not with its root.

#include <Eigen/Core>

#include "estimation/arc.h"
#include "signals/geometry.h"

namespace robot_control {

struct CovarianceStep {
  Chord chord;                     ///< of the fused motion
  Motion per_turn;                 ///< base motion per radian of turn: forward, left; turn = 1
  double gain = 0;                 ///< K
  double dt = 0;                   ///< s, of the gyro's increment
  double distance_variance = 0;    ///< m²
  double wheel_turn_variance = 0;  ///< rad²
  double gyro_turn_variance = 0;   ///< rad²
};

class PoseCovariance {
 public:
  /// (rad/s)²
  explicit PoseCovariance(double initial_bias_variance) noexcept : initial_bias_variance_(initial_bias_variance) {
    reset();
  }

  void reset() noexcept;
  void reset_pose() noexcept;  ///< the pose is known to be zero; the bias stays as uncertain as it was

  /// Takes (x, y, yaw) of a published 6×6 matrix; the bias is as unknown as at the start.
  void restore(const Matrix6& pose_covariance) noexcept;

  void step(const CovarianceStep& step) noexcept;
  void grow_bias(double variance) noexcept { covariance_(3, 3) += variance; }  ///< (rad/s)²
  void grow_pose(double position_variance, double yaw_variance) noexcept;      ///< m², rad²

  /// A measurement of the bias with `variance`: returns the gain k.
  double learn_bias(double variance) noexcept;

  double bias_variance() const noexcept { return covariance_(3, 3); }
  double at(int row, int column) const noexcept { return covariance_(row, column); }

 private:
  Eigen::Matrix4d covariance_;
  double initial_bias_variance_;
};

}  // namespace robot_control
