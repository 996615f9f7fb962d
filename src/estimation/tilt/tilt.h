#pragma once
/// Estimates the direction of up in base axes and the accelerometer's bias along and across. The gyro turns the
/// direction. The accelerometer corrects it at rest, and in motion by its difference from the wheels' acceleration.
///
///   u̇ = −ω × u        accelerometer/g = u + β at rest        u: unit vector; β: bias/g, along and across
///
/// The error state is u_x, u_y, β_x, β_y. One rest shows only their sums. Rests in two headings separate them, because
/// gravity turns against the robot and the bias does not.
///
/// The gyro measures the change of the tilt between rests. If it is unreliable, the floor is assumed to be plane. Then
/// the tilt is that of the last rest, turned by the wheels, with a deviation of kFloor. If the rest contradicts this by
/// more than kSignificant deviations, the tilt is unknown. The bias keeps its variance, because a failing gyro does not
/// change it.
///
/// The gyro is unreliable if it turned the robot over faster than kTipping, by kFloor in all. It is also unreliable if
/// it repeated one sample for kMaxHoldTime. A robot on its wheels does neither.
///
/// The tilt walks by kSlowAcceleration/g, 2 mrad, per √s. It is bounded by kSteepest, because the robot stands on its
/// wheels. The gyro's x and y count only after a first rest has shown their bias: a broken axis reads −31 °/s at rest.

#include <Eigen/Core>
#include <array>

#include "estimation/values.h"
#include "robot/gravity.h"
#include "signals/geometry.h"

namespace robot_control {

struct TiltParams {
  double accelerometer = 1.716e-3;  ///< m/s²/√Hz
  double bias = 0.2;                ///< m/s², standard deviation at switch-on
  double bias_walk = 6.5e-5;        ///< m/s²/√s
};

class Tilt {
 public:
  explicit Tilt(const TiltParams& params = {}) noexcept;

  /// Turns by `rate` (rad/s, bias removed). `known` states that x and y count.
  void turn(const Vector3& rate, double dt, bool known) noexcept;
  /// Adds the turn by the wheels, rad.
  void roll(double turn) noexcept { rolled_ += turn; }

  /// Corrects by the excess of gravity and bias over the values in use, along and across, over the last `dt`; all in
  /// m/s².
  void correct(double along, double across, double dt, double deviation) noexcept;

  /// Corrects at rest: `force` (m/s²) is the accelerometer's mean over `dt`.
  void rest(const Vector3& force, double dt) noexcept;

  /// Continues an earlier process: `up` is in base axes, `bias` in m/s² along and across.
  void set(const Vector3& up, const std::array<double, 2>& bias) noexcept;

  Vector3 up() const noexcept { return array(now_.up); }
  double roll() const noexcept;                                                     ///< rad
  double pitch() const noexcept;                                                    ///< rad
  double bias(int axis) const noexcept { return kGravity * now_.bias[axis]; }       ///< m/s², along and across
  double vertical_bias() const noexcept { return vertical_; }                       ///< m/s², along u
  double covariance(int i, int k) const noexcept { return now_.covariance(i, k); }  ///< covariance of u_x, u_y
  /// Returns the variance of gravity and bias together, in (m/s²)².
  double acceleration_variance(int axis) const noexcept { return kGravity * kGravity * now_.variance(axis); }
  /// Returns `force` without gravity and bias along and across, m/s².
  std::array<double, 2> acceleration(const Vector3& force) const noexcept {
    return {force[0] - kGravity * (now_.up[0] + now_.bias[0]), force[1] - kGravity * (now_.up[1] + now_.bias[1])};
  }

 private:
  struct Estimate {
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    Eigen::Vector2d bias = Eigen::Vector2d::Zero();        ///< β
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< covariance of u_x, u_y, β_x, β_y

    void turn(double angle) noexcept;  ///< turns the covariance alone by the robot's turn about the vertical
    Eigen::Vector2d innovation(const Eigen::Vector2d& sum) const noexcept { return sum - up.head<2>() - bias; }
    double variance(int axis) const noexcept;  ///< variance of u + β
    bool contradicts(const Eigen::Vector2d& sum, double noise) const noexcept;
    void update(const Eigen::Vector2d& sum, double noise) noexcept;
    void bound() noexcept;
  };

  void age() noexcept;
  Estimate on_the_floor() const noexcept;

  TiltParams params_;
  Estimate now_;
  double vertical_ = 0;
  Estimate rested_;               ///< estimate at the end of the last rest
  bool has_rested_ = false;       ///< There was a rest.
  double rolled_ = 0;             ///< rad, by the wheels since the last rest
  double unreliable_ = 0;         ///< rad, by a gyro that turned the robot over, since the last rest
  double stuck_ = 0;              ///< s
  Vector3 last_{};                ///< rad/s
  double turned_ = 0, time_ = 0;  ///< rad, s: since the last age()
};

}  // namespace robot_control
