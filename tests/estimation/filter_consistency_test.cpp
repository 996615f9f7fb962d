// Does the filter know its own error? Monte Carlo with noise drawn exactly as it is modelled: the normalised estimation
// error squared, xᵀ P⁻¹ x of d components, is χ² of d degrees of freedom, and its sum over N runs χ² of N·d
// (Y. Bar-Shalom et al., Estimation with Applications to Tracking and Navigation, 2001, section 5.4.2).

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>
#include <vector>

#include "estimation/filter/algebra.h"
#include "estimation/filter_errors.h"

namespace robot_control {
namespace {

using Filter = ErrorStateFilter;
using Eigen::Vector3d;

constexpr double kLongPeriod = 0.01;
constexpr int kSteps = 2000;
constexpr unsigned kRuns = 100;
const ContactGeometry kCentredGeometry{
    .wheel_base = 0.5, .middle_y = 0, .middle_x = -0.1, .height = -0.2, .imu_in_base = {0.1, 0, 0.2}};
// Small enough for a linear error, large enough to be learned.
const FilterPrior kPrior{.tilt = 0.005,
                         .gyro_bias = 0.002,
                         .accelerometer_bias = 0.02,
                         .radius_ratio = 0.005,
                         .wheel_base = 0.02,
                         .gyro_scale = 1e-3};

/// Wilson and Hilferty: χ²_n quantile ≈ n (1 − 2/9n + z √(2/9n))³; at n > 100 good to 0.1 %.
double chi_square_quantile(double n, double z) {
  const double spread = 2 / (9 * n);
  return n * std::pow(1 - spread + z * std::sqrt(spread), 3);
}

/// The truth is a filter that is told exact rates and forces; what the estimating one is told is spoilt as its noise
/// says.
class Trial {
 public:
  explicit Trial(unsigned seed) : random_(seed) {
    filter_.covariance.block<3, 3>(Filter::kVelocity, Filter::kVelocity) = 1e-4 * Eigen::Matrix3d::Identity();
    Filter::Column error;
    for (int i = 0; i < Filter::kSize; ++i) error[i] = std::sqrt(filter_.covariance(i, i)) * normal();
    const FilterPrior exact{
        .tilt = 0, .gyro_bias = 0, .accelerometer_bias = 0, .radius_ratio = 0, .wheel_base = 0, .gyro_scale = 0};
    truth_ = Filter(kCentredGeometry, filter_.noise(), exact);
    filter_.velocity = truth_.velocity = rolling(0);
    truth_.inject(error);
    contact_ = contact(truth_, rate(0));
  }

  void step() {
    const double t = kLongPeriod * ++k_;
    const Vector3d omega = rate(t);
    truth_.gyro_bias += std::sqrt(kLongPeriod) * filter_.noise().gyro_bias_walk * vector();
    truth_.accelerometer_bias += std::sqrt(kLongPeriod) * filter_.noise().accelerometer_bias_walk * vector();

    // The contact slides by what the filter takes for noise.
    const double slide = filter_.noise().lateral / std::sqrt(kLongPeriod) * normal();
    const double jump = filter_.noise().vertical / std::sqrt(kLongPeriod) * normal();
    Vector3d wanted = rolling(t);
    wanted.y() += slide;
    wanted.z() += jump;
    Filter::Motion exact = motion(omega);
    Vector3d steady = (wanted - truth_.velocity) / kLongPeriod;
    for (int i = 0; i < 4; ++i) {  // what accelerates from velocity to wanted; converges by ω dt/2 each time
      const Vector3d u = truth_.velocity + kLongPeriod / 2 * (steady - omega.cross(truth_.velocity));
      steady = (wanted - truth_.velocity) / kLongPeriod + omega.cross(u);
    }
    const Eigen::Matrix3d middle =
        truth_.rotation * Eigen::AngleAxisd(omega.norm() * kLongPeriod / 2, omega.normalized()).toRotationMatrix();
    const Vector3d force = steady + middle.transpose() * Vector3d(0, 0, Filter::kGravity);

    Filter::Motion measured = exact;
    exact.gyro = omega / (1 + truth_.gyro_scale) + truth_.gyro_bias;
    exact.accelerometer = force + truth_.accelerometer_bias;
    measured.gyro = *exact.gyro + filter_.noise().gyro / std::sqrt(kLongPeriod) * vector();
    measured.accelerometer = *exact.accelerometer + filter_.noise().accelerometer / std::sqrt(kLongPeriod) * vector();
    truth_.predict(exact);
    const double path = (std::abs(exact.left_speed) + std::abs(exact.right_speed)) / 2 * kLongPeriod;
    truth_.radius_ratio += filter_.noise().radius_ratio_walk * std::sqrt(path) * normal();
    truth_.wheel_base += filter_.noise().wheel_base_walk * std::sqrt(path) * normal();
    const double wound = std::abs(truth_.smooth_rate - truth_.slow_rate) / Filter::kWindUp;
    const double turning = algebra::square(filter_.noise().turn_slip) * std::abs(omega.z()) +
                           algebra::square(filter_.noise().wind_up) * wound;
    const double twist = kCentredGeometry.wheel_base / 2 * std::sqrt(turning * kLongPeriod) * normal();
    truth_.travel += Eigen::Vector2d(twist, -twist);
    truth_.travel.array() += filter_.noise().common_slip * std::sqrt(path) * normal();
    for (const int side : {0, 1}) {
      const double speed = side == 0 ? exact.left_speed : exact.right_speed;
      truth_.travel[side] += filter_.noise().wheel_slip * std::sqrt(std::abs(speed) * kLongPeriod) * normal();
    }

    filter_.predict(measured);
    for (const int side : {0, 1}) {
      filter_.correct_travel(side, truth_.travel[side] + filter_.noise().encoder * normal());
    }
    filter_.correct_lateral(kLongPeriod);
    filter_.correct_vertical(kLongPeriod);
  }

  double nees(const std::vector<int>& indices) const {
    const Filter::Column all = error_between(filter_, truth_);
    const auto n = static_cast<Eigen::Index>(indices.size());
    Eigen::VectorXd error(n);
    Eigen::MatrixXd covariance(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      error[i] = all[indices[static_cast<std::size_t>(i)]];
      for (Eigen::Index j = 0; j < n; ++j) {
        covariance(i, j) =
            filter_.covariance(indices[static_cast<std::size_t>(i)], indices[static_cast<std::size_t>(j)]);
      }
    }
    return error.dot(covariance.ldlt().solve(error));
  }

 private:
  double normal() { return normal_(random_); }
  Vector3d vector() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }
  static Vector3d rate(double t) { return {0, 0, 0.4 * std::sin(0.7 * t) + 0.1}; }
  static Vector3d rolling(double t) {
    const double speed = 0.5 + 0.3 * std::sin(0.4 * t);
    return Vector3d(speed, 0, 0) -
           rate(t).cross(Vector3d(kCentredGeometry.middle_x, kCentredGeometry.middle_y, kCentredGeometry.height));
  }
  static Vector3d contact(const Filter& filter, const Vector3d& rate) {
    return filter.velocity +
           rate.cross(Vector3d(kCentredGeometry.middle_x, kCentredGeometry.middle_y, kCentredGeometry.height));
  }
  Filter::Motion motion(const Vector3d& omega) const {
    Filter::Motion motion;
    motion.dt = kLongPeriod;
    motion.left_speed = (truth_.velocity.x() - omega.z() * truth_.lever(0)) / (1 - truth_.radius_ratio / 2);
    motion.right_speed = (truth_.velocity.x() - omega.z() * truth_.lever(1)) / (1 + truth_.radius_ratio / 2);
    return motion;
  }

  std::mt19937 random_;
  std::normal_distribution<double> normal_{0, 1};
  Filter filter_{kCentredGeometry, {}, kPrior};
  Filter truth_{kCentredGeometry, {}, kPrior};
  Vector3d contact_;
  int k_ = 0;
};

TEST(FilterConsistency, TheErrorIsThatOfTheCovariance) {
  const std::vector<std::pair<const char*, std::vector<int>>> parts{
      {"x, y, yaw", {0, 1, 5}},
      {"tilt", {3, 4}},
      {"velocity", {6, 7, 8}},
      {"travel", {9, 10}},
      {"gyro bias", {11, 12, 13}},
      {"accelerometer bias", {14, 15, 16}},
      {"radius ratio, wheel base, gyro scale", {17, 18, 19}},
  };
  constexpr int kChecks = 4;
  // 95 % that all of them hold: each of the 28 within 1 − 0.05/28, two-sided.
  constexpr double kBand = 3.13;
  std::vector<Trial> runs;
  for (unsigned seed = 0; seed < kRuns; ++seed) runs.emplace_back(seed);
  for (int k = 1; k <= kSteps; ++k) {
    for (Trial& run : runs) run.step();
    if (k % (kSteps / kChecks) != 0) continue;
    for (const auto& [name, indices] : parts) {
      double sum = 0;
      for (const Trial& run : runs) sum += run.nees(indices);
      const double n = static_cast<double>(kRuns * indices.size());
      EXPECT_GT(sum, chi_square_quantile(n, -kBand)) << name << " at step " << k << ": mean " << sum / kRuns;
      EXPECT_LT(sum, chi_square_quantile(n, kBand)) << name << " at step " << k << ": mean " << sum / kRuns;
    }
  }
}

}  // namespace
}  // namespace robot_control
