#pragma once
/// The simple part: wheels for the distance, gyro minus the bias of the rests so far for the heading. The wheels alone
/// where the gyro is absent.
///
///   ψ ← ψ + (gyro − b) dt        (x, y) ← (x, y) + ½ Σ_side travel_side (cos ψ̄, sin ψ̄)
///
/// ψ̄ in the middle of the way between two readings of that side. (x, y) is the middle of the wheels. Errors: ψ by the
/// gyro's noise, its bias b and scale, the way by slip noise per √distance; their covariance is that of (x, y, ψ, b).

#include <array>
#include <cmath>
#include <initializer_list>

namespace robot_control {

struct PlanarPose {
  double x = 0, y = 0;  ///< m
  double yaw = 0;       ///< rad
};

/// Symmetric: of x, y [m], yaw [rad] and the gyro's bias [rad/s].
struct PlanarCovariance {
  double xx = 0, xy = 0, yy = 0;
  double xw = 0, yw = 0, ww = 0;  ///< w: yaw
  double xb = 0, yb = 0, wb = 0, bb = 0;

  /// Of x, y and yaw.
  std::array<std::array<double, 3>, 3> pose() const noexcept { return {{{xx, xy, xw}, {xy, yy, yw}, {xw, yw, ww}}}; }
};

struct PlanarNoise {
  double gyro = 2.44e-4;  ///< rad/s/√Hz
  double scale = 5.8e-4;  ///< rad/√rad, of the gyro
  double slip = 5.0e-3;   ///< m/√m: skid steers on real floors show 2e-3 … 1.6e-2
  double turn = 0.05;     ///< rad/√rad, of the wheels where they are all there is for the heading
};

class PlanarTrack {
 public:
  explicit PlanarTrack(const PlanarNoise& noise) noexcept : noise_(noise) {}

  /// `covariance.bb` and its row are ignored: the bias is known to `bias_variance` from here on.
  void place(const PlanarPose& pose, const PlanarCovariance& covariance, double bias_variance) noexcept {
    pose_ = pose;
    covariance_ = covariance;
    covariance_.xb = covariance_.yb = covariance_.wb = 0;
    covariance_.bb = bias_variance;
    path_ = 0;
    begin_ = covariance_;
  }

  /// The heading turned by `angle` in dt, by the gyro (else by the wheels).
  void turn(double angle, double dt, bool by_gyro) noexcept;
  /// One side went `distance`, in the middle of which the robot's heading was `before` rad less than it is now.
  void roll(double distance, double before) noexcept;
  /// What the heading seemed to turn in a rest.
  void take_back(double angle) noexcept { pose_.yaw -= angle; }
  /// The bias is known to `variance` from something else than this track.
  void learn_bias(double variance) noexcept {
    if (!(variance < covariance_.bb)) return;
    const double left = variance / covariance_.bb;
    for (double* entry : {&covariance_.bb, &covariance_.xb, &covariance_.yb, &covariance_.wb}) *entry *= left;
  }

  const PlanarPose& pose() const noexcept { return pose_; }
  const PlanarCovariance& covariance() const noexcept { return covariance_; }
  double path() const noexcept { return path_; }  ///< m, since it was placed
  /// Variances gained since it was placed: of the position, m², and of the yaw, rad².
  double position_growth() const noexcept { return covariance_.xx + covariance_.yy - begin_.xx - begin_.yy; }
  double yaw_growth() const noexcept { return covariance_.ww - begin_.ww; }

 private:
  PlanarNoise noise_;
  PlanarPose pose_;
  PlanarCovariance covariance_;
  PlanarCovariance begin_;
  double path_ = 0;
};

}  // namespace robot_control
