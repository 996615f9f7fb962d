#pragma once
/// An error-state Kalman filter for a body on legs, with the feet that stand as landmarks (R. Hartley et al., IJRR 39
/// (2020) 402; M. Bloesch et al., RSS 2012). It has one owner, LeggedEstimator.
///
/// The body is a point and axes: the IMU's place and the axes of the base. R is its attitude, v its velocity and p its
/// position in odom. The measured rate is ω, the specific force f, both in base axes, with the biases b and c. The
/// vector from the body to foot i is eᵢ in odom axes. This foot rolls with the velocity ρᵢ.
///
///   Ṙ = R (ω − b)×    v̇ = R (f − c) + g    ṗ = v    ėᵢ = −v + ρᵢ
///
/// The errors are right-invariant: R̂ = exp(ξ) R, and v̂ − exp(ξ) v, êᵢ − exp(ξ) eᵢ. Those of p, b and c are differences.
/// Their changes depend on the state by v̂ and êᵢ alone. So yaw, which nothing measures, gains no certainty from a
/// linearisation elsewhere. A foot at kᵢ by kinematics measures êᵢ − R̂ kᵢ, one entry of the error for each axis, and so
/// does each other measurement. They are used one after the other:
///
///   gain K = P column / (P entry + variance)
///
/// A foot that lands becomes a landmark where it is, which changes nothing else. One that stands may creep. An
/// innovation beyond kGate deviations means that it has moved. Then its own variance grows by the innovation's square,
/// so that the foot moves and not the body.
///
/// Nothing measures x and y. The gain would move them by what the yaw of the whole way was, by decimetres. Instead the
/// feet that are held keep their mean place in odom, which must not jump (REP 105). Without such feet no correction
/// moves x and y. So their gain is k, not K. Their covariance becomes P − S K Kᵀ + S (k − K)(k − K)ᵀ, with the variance
/// S of the innovation.
///
/// The height h of one level plane is a state, too. A foot on it measures p_z + eᵢ_z − h, whose error is that of p_z,
/// êᵢ_z and ĥ, and ξ_x êᵢ_y − ξ_y êᵢ_x.
///
/// All functions are real-time safe.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "machine/legs/leg_model.h"
#include "signals/geometry.h"

namespace robot_control {

class LegFilter {
 public:
  static constexpr double kGyroNoise = 5e-4;           ///< rad/s/√Hz
  static constexpr double kGyroWalk = 2e-5;            ///< rad/s/√s
  static constexpr double kAccelerometerNoise = 0.07;  ///< m/s²/√Hz
  static constexpr double kAccelerometerWalk = 2e-4;   ///< m/s²/√s
  static constexpr double kGyroBias = 0.02;            ///< rad/s, before a rest
  static constexpr double kAccelerometerBias = 0.2;    ///< m/s²
  static constexpr double kFoot = 5e-4;                ///< m, of a foot's place by kinematics
  static constexpr double kGate = 8;

  /// Entries of the error.
  enum Entry : int { kTurn = 0, kSpeed = 3, kPlace = 6, kRateBias = 9, kForceBias = 12, kFeet = 15, kGround = 27 };
  static constexpr int kEntries = 28;  ///< even, for aligned columns
  using Column = Eigen::Matrix<double, kEntries, 1>;
  using Covariance = Eigen::Matrix<double, kEntries, kEntries>;

  struct State {
    std::array<double, 4> attitude{0, 0, 0, 1};  ///< x y z w, base → odom
    Vector3 velocity{}, position{};              ///< m/s, m
    Vector3 rate_bias{}, force_bias{};           ///< rad/s, m/s², base axes
    std::array<Vector3, kLegs> feet{};           ///< m, eᵢ
    double ground = 0;                           ///< m, h
    alignas(16) std::array<double, kEntries * kEntries> covariance{};
  };

  explicit LegFilter(State& state) noexcept : state_(state) {}

  /// Begins with this attitude and velocity, known to `tilt` [rad] and `speed` [m/s]. Position, yaw and biases, with
  /// their covariances, stay.
  void begin(const Eigen::Quaterniond& attitude, const Eigen::Vector3d& velocity, double tilt, double speed) noexcept;

  /// Turns odom by this angle in rad about z, beneath the position.
  void turn(double angle) noexcept;

  /// `rate` and `force` are measured; `rolling` is in base axes. Feet creep with the density `creep` [m/√s].
  void predict(const Eigen::Vector3d& rate, const Eigen::Vector3d& force,
               const std::array<Eigen::Vector3d, kLegs>& rolling, double creep, double dt) noexcept;

  /// `place` is in base axes, from the body.
  void land(std::size_t foot, const Eigen::Vector3d& place) noexcept;

  /// This foot keeps its place in odom in this cycle, unless it moved. Call it before the measurements.
  void hold(std::size_t foot) noexcept { held_[foot] = true; }

  /// Measurements of one cycle; `finish` corrects the state by all of them.
  void stand(std::size_t foot, const Eigen::Vector3d& place) noexcept;
  void rest(const Eigen::Vector3d& rate, double deviation) noexcept;  ///< the measured rate is the bias
  void stop(double deviation) noexcept;                               ///< the velocity is zero
  /// The foot is on the plane, to this deviation [m]. Without a correction it returns false if the foot is `gate`
  /// deviations beside it.
  bool touch(std::size_t foot, double deviation, double gate) noexcept;
  void finish() noexcept;

  /// The plane is now where this foot is, to this deviation [m].
  void set_ground(std::size_t foot, double deviation) noexcept;
  /// Returns whether two feet, known to this deviation [m] each, are as high as each other, within `gate` deviations.
  bool as_high(std::size_t foot, std::size_t other, double deviation, double gate) const noexcept;
  Eigen::Vector3d foot(std::size_t foot) const noexcept { return Eigen::Vector3d(state_.feet[foot].data()); }
  double height(std::size_t foot) const noexcept { return state_.position[2] + state_.feet[foot][2]; }  ///< m
  /// Returns the largest variance of the velocity in m²/s².
  double speed_variance() const noexcept { return covariance().diagonal().segment<3>(kSpeed).maxCoeff(); }
  /// Returns the variance of roll and pitch together in rad².
  double tilt_variance() const noexcept { return covariance().diagonal().segment<2>(kTurn).sum(); }

  /// Sets entry and all of its covariances to zero, but `variance` on the diagonal.
  void set_variance(int entry, double variance) noexcept;

 private:
  Eigen::Quaterniond attitude() const noexcept;
  Eigen::Map<Covariance, Eigen::Aligned16> covariance() noexcept {
    return Eigen::Map<Covariance, Eigen::Aligned16>(state_.covariance.data());
  }
  Eigen::Map<const Covariance, Eigen::Aligned16> covariance() const noexcept {
    return Eigen::Map<const Covariance, Eigen::Aligned16>(state_.covariance.data());
  }
  Column height_row(std::size_t foot) const noexcept;
  void measure(int entry, double error, double variance) noexcept;
  void correct(const Column& column, double innovation, double expected) noexcept;

  State& state_;
  Column error_ = Column::Zero();
  std::array<bool, kLegs> held_{};  ///< stand, and did not move
};

}  // namespace robot_control
