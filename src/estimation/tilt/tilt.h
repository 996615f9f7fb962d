#pragma once
/// Which way is up, in base axes, and the accelerometer's bias along and across: gravity's direction turned by the
/// gyro, and corrected by what the accelerometer measures at rest, and beyond the wheels' acceleration.
///
///   u̇ = −ω × u        accelerometer/g = u + β at rest        u: unit vector; β: bias/g, along and across
///
/// Error state: u_x, u_y, β_x, β_y. One rest shows their sums alone; rests in two headings tell them apart, because
/// gravity turns against the robot and the bias does not. How the tilt changed from one rest to the next, the gyro
/// measures; where it is unreliable, the floor is taken to be plane: the tilt is that of the last rest, turned by the
/// wheels, known to kFloor. Where the rest contradicts that, too, by more than kSignificant deviations, the tilt is
/// unknown again: what failed on the way turns the tilt, it does not change the bias.
///
/// The tilt walks by kSlowAcceleration/g, 2 mrad, per √s.
///
/// The gyro is unreliable where it turned the robot over faster than kTipping, by kFloor in all, or repeated one sample
/// for kLongestHold: a robot on its wheels does neither.
///
/// Bounded by kSteepest: the robot stands on its wheels. The gyro's x and y count after a first rest only, when their
/// bias is known: a broken axis reads −31 °/s at rest.

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

  /// rad/s, bias removed. `known`: x and y count.
  void turn(const Vector3& rate, double dt, bool known) noexcept;
  /// By the wheels, rad.
  void roll(double turn) noexcept { rolled_ += turn; }

  /// By how much gravity and bias are larger than taken, m/s², along and across, over the last `dt`; deviation m/s².
  void correct(double along, double across, double dt, double deviation) noexcept;

  /// The robot rests: `force` m/s² is its accelerometer's mean over `dt`.
  void rest(const Vector3& force, double dt) noexcept;

  /// Of an earlier process: `up` base axes, `bias` m/s² along and across.
  void set(const Vector3& up, const std::array<double, 2>& bias) noexcept;

  Vector3 up() const noexcept { return array(now_.up); }
  double roll() const noexcept;                                                     ///< rad
  double pitch() const noexcept;                                                    ///< rad
  double bias(int axis) const noexcept { return kGravity * now_.bias[axis]; }       ///< m/s², along and across
  double vertical_bias() const noexcept { return vertical_; }                       ///< m/s², along u
  double covariance(int i, int k) const noexcept { return now_.covariance(i, k); }  ///< of u_x, u_y
  /// (m/s²)², of gravity and bias together.
  double acceleration_variance(int axis) const noexcept { return kGravity * kGravity * now_.variance(axis); }
  /// m/s²: `force` without gravity and bias, along and across.
  std::array<double, 2> acceleration(const Vector3& force) const noexcept {
    return {force[0] - kGravity * (now_.up[0] + now_.bias[0]), force[1] - kGravity * (now_.up[1] + now_.bias[1])};
  }

 private:
  struct Estimate {
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    Eigen::Vector2d bias = Eigen::Vector2d::Zero();        ///< β
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of u_x, u_y, β_x, β_y

    void turn(double angle) noexcept;  ///< of the robot, about the vertical: of the covariance alone
    Eigen::Vector2d innovation(const Eigen::Vector2d& sum) const noexcept { return sum - up.head<2>() - bias; }
    double variance(int axis) const noexcept;  ///< of u + β
    bool contradicts(const Eigen::Vector2d& sum, double noise) const noexcept;
    void update(const Eigen::Vector2d& sum, double noise) noexcept;
    void bound() noexcept;
  };

  void age() noexcept;
  Estimate on_the_floor() const noexcept;

  TiltParams params_;
  Estimate now_;
  double vertical_ = 0;
  Estimate rested_;               ///< at the end of the last rest
  bool has_rested_ = false;       ///< there was one
  double rolled_ = 0;             ///< rad, since then, by the wheels
  double unreliable_ = 0;         ///< rad, likewise, by a gyro that turned the robot over
  double stuck_ = 0;              ///< s
  Vector3 last_{};                ///< rad/s
  double turned_ = 0, time_ = 0;  ///< rad, s: since the covariance aged
};

}  // namespace robot_control
