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
/// A foot that lands becomes a landmark where it is, which changes nothing else. One that stands may slide, with the
/// density kSlide, and kLandSlide at the edges of its stance. An innovation
/// beyond kGate deviations means that it has moved. Then its own variance grows by the innovation's square, so that the
/// foot moves and not the body.
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
  static constexpr double kSlide = 0.003;              ///< m/√s
  static constexpr double kLandSlide = 0.03;           ///< m/√s
  static constexpr double kGate = 4;

  /// Entries of the error.
  enum Entry : int { kTurn = 0, kSpeed = 3, kPlace = 6, kRateBias = 9, kForceBias = 12, kFeet = 15, kEntries = 27 };
  static constexpr int kRows = 28;  ///< even, for aligned columns; the last one is 0
  using Covariance = Eigen::Matrix<double, kRows, kRows>;

  struct State {
    std::array<double, 4> attitude{0, 0, 0, 1};  ///< x y z w, base → odom
    Vector3 velocity{}, position{};              ///< m/s, m
    Vector3 rate_bias{}, force_bias{};           ///< rad/s, m/s², base axes
    std::array<Vector3, kLegs> feet{};           ///< m, eᵢ
    alignas(16) std::array<double, kRows * kRows> covariance{};
  };

  explicit LegFilter(State& state) noexcept : state_(state) {}

  /// Begins with this attitude and velocity, known to `tilt` [rad] and `speed` [m/s]. Position, yaw and biases, with
  /// their covariances, stay.
  void begin(const Eigen::Quaterniond& attitude, const Eigen::Vector3d& velocity, double tilt, double speed) noexcept;

  /// Turns odom by this angle in rad about z, beneath the position.
  void turn(double angle) noexcept;

  /// `rate` and `force` are measured; `rolling` is in base axes.
  void predict(const Eigen::Vector3d& rate, const Eigen::Vector3d& force,
               const std::array<Eigen::Vector3d, kLegs>& rolling, const std::array<double, kLegs>& slide,
               double dt) noexcept;

  /// `place` is in base axes, from the body.
  void land(std::size_t foot, const Eigen::Vector3d& place) noexcept;

  /// Measurements of one cycle; `finish` corrects the state by all of them.
  void stand(std::size_t foot, const Eigen::Vector3d& place) noexcept;
  void rest(const Eigen::Vector3d& rate, double deviation) noexcept;  ///< the measured rate is the bias
  void stop(double deviation) noexcept;                               ///< the velocity is zero
  void finish() noexcept;

  /// Sets entry and all of its covariances to zero, but `variance` on the diagonal.
  void set_variance(int entry, double variance) noexcept;

 private:
  Eigen::Quaterniond attitude() const noexcept;
  Eigen::Map<Covariance, Eigen::Aligned16> covariance() noexcept {
    return Eigen::Map<Covariance, Eigen::Aligned16>(state_.covariance.data());
  }
  void measure(int entry, double error, double variance) noexcept;

  State& state_;
  Eigen::Matrix<double, kRows, 1> error_ = Eigen::Matrix<double, kRows, 1>::Zero();
};

}  // namespace robot_control
