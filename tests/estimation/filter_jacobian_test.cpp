// Covariance against nominal state: every column of F and every H, by numerical differentiation.
//
// F and H stand nowhere in the interface. They are found again from what they do: without noise,
//   P = eᵢ eᵢᵀ → P' − Q = fᵢ fᵢᵀ        P = α I → corrections = α Hᵀ y/S, nis = y²/S

#include <gtest/gtest.h>

#include <random>

#include "estimation/filter_errors.h"

namespace robot_control {
namespace {

using Filter = ErrorStateFilter;
using Eigen::Vector3d;
constexpr double kStep = 1e-4;  // of a central difference: 1e-16/1e-4 rounding, 1e-8 curvature

const ContactGeometry kMirroredGeometry{
    .wheel_base = 0.5, .middle_y = -0.05, .middle_x = -0.2, .height = -0.3, .imu_in_base = {0.2, 0.05, 0.3}};

FilterNoise no_noise() {
  FilterNoise noise;
  noise.gyro = noise.gyro_bias_walk = noise.accelerometer = noise.accelerometer_bias_walk = noise.wheel_slip = 0;
  return noise;
}

Filter::Column unit(int index, double size = 1) {
  Filter::Column error = Filter::Column::Zero();
  error[index] = size;
  return error;
}

/// A state in the middle of a drive: tilted, turning, sliding a little, with biases. `calibrated`: ε, β, κ are not
/// zero.
Filter state(std::mt19937& random, bool calibrated) {
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&](double size) {
    const double x = any(random), y = any(random), z = any(random);
    return Vector3d(size * x, size * y, size * z);
  };
  Filter filter(kMirroredGeometry, no_noise(), {});
  filter.position = vector(5);
  const Vector3d tilt = vector(0.4);
  filter.rotation = Eigen::AngleAxisd(3 * any(random), Vector3d::UnitZ()).toRotationMatrix() *
                    Eigen::AngleAxisd(tilt.norm(), tilt.normalized()).toRotationMatrix();
  filter.velocity = vector(1);
  filter.gyro_bias = vector(0.05);
  filter.accelerometer_bias = vector(0.2);
  if (calibrated) {
    filter.radius_ratio = 0.01;
    filter.wheel_base = 0.03;
    filter.gyro_scale = 1e-3;
  }
  return filter;
}

struct Sensors {
  bool gyro;
  bool accelerometer;
  bool calibrated;
};

class TransitionJacobian : public testing::TestWithParam<Sensors> {
 protected:
  static constexpr double kPeriod = 1e-5;

  Filter::Motion motion(std::mt19937& random, const Filter& filter) const {
    std::uniform_real_distribution<double> any(-1, 1);
    const auto vector = [&](double size) {
      const double x = any(random), y = any(random), z = any(random);
      return Vector3d(size * x, size * y, size * z);
    };
    Filter::Motion motion;
    motion.dt = kPeriod;
    Vector3d rate = vector(1);
    rate.y() = 0;  // what pitching does to the columns of ε and κ is left out on purpose: it is small, and noise
    const Vector3d force = vector(2) + filter.rotation.transpose() * Vector3d(0, 0, Filter::kGravity);
    if (GetParam().gyro) motion.gyro = rate / (1 + filter.gyro_scale) + filter.gyro_bias;
    if (GetParam().accelerometer) motion.accelerometer = force + filter.accelerometer_bias;
    roll(motion, filter, rate.z());
    return motion;
  }

  /// Wheels that turn as the gyro says.
  static void roll(Filter::Motion& motion, const Filter& filter, double rate) {
    const double half = rate * kMirroredGeometry.wheel_base * (1 + filter.wheel_base) / 2;
    motion.left_speed = (0.5 - half) / (1 - filter.radius_ratio / 2);
    motion.right_speed = (0.5 + half) / (1 + filter.radius_ratio / 2);
    motion.left_travel = motion.left_speed * kPeriod;
    motion.right_travel = motion.right_speed * kPeriod;
  }

  static Filter::Covariance propagated(Filter filter, const Filter::Motion& motion, const Filter::Covariance& start) {
    filter.covariance = start;
    filter.predict(motion);
    return filter.covariance;
  }

  static Filter::Covariance transition(const Filter& filter, const Filter::Motion& motion) {
    const Filter::Covariance noise = propagated(filter, motion, Filter::Covariance::Zero());
    Filter::Covariance f;
    for (int i = 0; i < Filter::kSize; ++i) {
      const Filter::Column e = unit(i);
      const Filter::Covariance square = propagated(filter, motion, e * e.transpose()) - noise;
      f.col(i) = square.col(i) / std::sqrt(square(i, i));
    }
    return f;
  }

  static Filter::Covariance differences(const Filter& filter, const Filter::Motion& motion) {
    Filter::Covariance f;
    for (int i = 0; i < Filter::kSize; ++i) {
      Filter above = filter;
      Filter below = filter;
      above.inject(unit(i, kStep));
      below.inject(unit(i, -kStep));
      above.predict(motion);
      below.predict(motion);
      f.col(i) = error_between(below, above) / (2 * kStep);
    }
    return f;
  }

  /// Left out on purpose where the gyro is missing: the turn is the wheels' own, so that ε and β contradict no encoder
  /// (their column of the travel is zero where the robot goes as its wheels do), and do next to nothing to the
  /// velocity.
  bool left_out(int row, int column) const {
    if (GetParam().gyro) return false;
    const bool travel = row >= Filter::kTravel && row < Filter::kTravel + 2;
    const bool velocity = row >= Filter::kVelocity && row < Filter::kVelocity + 3;
    return (velocity || travel) && (column == Filter::kRadiusRatio || column == Filter::kWheelBase);
  }
};

// F is I + dt A of a discrete map that is exp(dt A) to second order: entries differ by at most (dt |A|)²; dt |A| is
// taken from the differences. Where ε, β, κ are not zero, the columns leave out factors 1 + ε, 1 + β, 1 + κ.
TEST_P(TransitionJacobian, IsThatOfTheNominalState) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    Filter filter = state(random, GetParam().calibrated);
    const Filter::Motion motion = this->motion(random, filter);
    // The columns of ε, β and κ take the smoothed rate, as it is in a steady turn.
    Filter turned = filter;
    turned.predict(motion);
    filter.smooth_rate = filter.slow_rate = turned.rate.z();
    const Filter::Covariance identity = Filter::Covariance::Identity();
    const Filter::Covariance expected = differences(filter, motion) - identity;
    const Filter::Covariance f = transition(filter, motion) - identity;
    const double second_order = expected.squaredNorm();
    const double factors = std::abs(filter.radius_ratio) + std::abs(filter.wheel_base) + std::abs(filter.gyro_scale);
    constexpr double kRounding = 2e-12;  // of the differences
    for (int row = 0; row < Filter::kSize; ++row) {
      for (int column = 0; column < Filter::kSize; ++column) {
        if (left_out(row, column)) continue;
        EXPECT_NEAR(f(row, column), expected(row, column),
                    second_order + factors * std::abs(expected(row, column)) + kRounding)
            << "seed " << seed << ", " << row << " by " << column;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sensors, TransitionJacobian,
                         testing::Values(Sensors{true, true, false}, Sensors{true, false, false},
                                         Sensors{false, true, false}, Sensors{false, false, false},
                                         Sensors{true, true, true}, Sensors{true, false, true},
                                         Sensors{false, true, true}, Sensors{false, false, true}),
                         [](const testing::TestParamInfo<Sensors>& sensors) {
                           return std::string(sensors.param.gyro ? "Gyro" : "NoGyro") +
                                  (sensors.param.accelerometer ? "Accelerometer" : "NoAccelerometer") +
                                  (sensors.param.calibrated ? "Calibrated" : "");
                         });

/// `innovation` is what the header says of the measurement; `correct` what the filter does with it, to the errors from
/// `first` to `last`: another gain than Kalman's tells no derivative.
template <class Innovation, class Correct>
void expect_measurement_jacobian(const Filter& filter, const char* name, Innovation innovation, Correct correct,
                                 int first = 0, int last = Filter::kSize - 1) {
  constexpr double kAlpha = 1e-12;  // H P Hᵀ beside the noise is nothing, and no gate refuses
  Filter corrected = filter;
  corrected.covariance = kAlpha * Filter::Covariance::Identity();
  const double y = innovation(filter);
  const Filter::Innovation result = correct(corrected);
  ASSERT_TRUE(result.used) << name;
  ASSERT_GT(result.nis, 0) << name;
  for (int i = first; i <= last; ++i) {
    Filter above = filter;
    Filter below = filter;
    above.inject(unit(i, kStep));
    below.inject(unit(i, -kStep));
    const double expected = -(innovation(above) - innovation(below)) / (2 * kStep);
    const double h = corrected.corrections()[i] * y / (result.nis * kAlpha);
    EXPECT_NEAR(h, expected, 1e-6 * std::max(1.0, std::abs(expected))) << name << ", column " << i;
  }
}

class MeasurementJacobian : public testing::Test {
 protected:
  MeasurementJacobian() : filter_(state(random_, false)) {
    filter_.rate = {0.3, -0.2, 0.7};
    rate_ = filter_.rate;
    bias_ = filter_.gyro_bias;
    const Vector3d contact{kMirroredGeometry.middle_x, kMirroredGeometry.middle_y, kMirroredGeometry.height};
    filter_.velocity = Vector3d(0.5, 1e-4, 2e-4) - rate_.cross(contact);  // almost rolls: the gate accepts it
    filter_.velocity.x() = 0.5;
  }
  /// Velocity of the middle of the contacts; the gyro's bias turns the rate.
  Vector3d contact(const Filter& filter) const {
    const Vector3d rate = rate_ - (filter.gyro_bias - bias_);
    return filter.velocity +
           rate.cross(Vector3d(kMirroredGeometry.middle_x, kMirroredGeometry.middle_y, kMirroredGeometry.height));
  }
  std::mt19937 random_{17};
  Filter filter_;
  Vector3d rate_, bias_;
};

TEST_F(MeasurementJacobian, OfTheContactSideways) {
  expect_measurement_jacobian(
      filter_, "lateral", [&](const Filter& filter) { return -contact(filter).y(); },
      [](Filter& filter) { return filter.correct_lateral(1e-3); });
}

TEST_F(MeasurementJacobian, OfTheContactUpwards) {
  expect_measurement_jacobian(
      filter_, "vertical", [&](const Filter& filter) { return -contact(filter).z(); },
      [](Filter& filter) { return filter.correct_vertical(1e-3); }, Filter::kVelocity, Filter::kTravel + 1);
}

TEST_F(MeasurementJacobian, OfTheTravel) {
  for (const int side : {0, 1}) {
    const double measured = filter_.travel[side] + 1e-5;
    expect_measurement_jacobian(
        filter_, "travel", [&](const Filter& filter) { return measured - filter.travel[side]; },
        [&](Filter& filter) { return filter.correct_travel(side, measured); });
  }
}

TEST_F(MeasurementJacobian, OfTheGyroAtRest) {
  for (const int axis : {0, 1, 2}) {
    const double mean = filter_.gyro_bias[axis] + 0.001;
    expect_measurement_jacobian(
        filter_, "gyro", [&](const Filter& filter) { return mean - filter.gyro_bias[axis]; },
        [&](Filter& filter) { return filter.correct_gyro_at_rest(axis, mean, 1e-6, Filter::Rest::kBegins); });
  }
}

TEST_F(MeasurementJacobian, OfTheAccelerometerAtRest) {
  const Vector3d mean = filter_.accelerometer_bias + filter_.rotation.transpose() * Vector3d(0, 0, Filter::kGravity) +
                        Vector3d(0.01, -0.02, 0.03);
  for (const int axis : {0, 1, 2}) {
    const auto innovation = [&](const Filter& filter) {
      const Vector3d up = filter.rotation.transpose() * Vector3d(0, 0, Filter::kGravity);
      return mean[axis] - filter.accelerometer_bias[axis] - up[axis];
    };
    expect_measurement_jacobian(
        filter_, "accelerometer", innovation,
        [&](Filter& filter) { return filter.correct_accelerometer_at_rest(axis, mean[axis], 1e-4); },
        Filter::kOrientation);
  }
}

// Its deviation is that of accelerometer − ba + Rᵀ g, by the same derivative.
TEST_F(MeasurementJacobian, OfTheInertialAcceleration) {
  std::normal_distribution<double> normal(0, 1);
  Filter::Covariance root;
  for (int i = 0; i < Filter::kSize; ++i) {
    for (int j = 0; j < Filter::kSize; ++j) root(i, j) = 0.1 * normal(random_);
  }
  filter_.covariance = root * root.transpose();
  const Vector3d deviation = filter_.acceleration_deviation();
  for (const int axis : {0, 1, 2}) {
    Filter::Column h;
    for (int i = 0; i < Filter::kSize; ++i) {
      const auto acceleration = [&](double size) {
        Filter moved = filter_;
        moved.inject(unit(i, size));
        return (moved.rotation.transpose() * Vector3d(0, 0, -Filter::kGravity) - moved.accelerometer_bias)[axis];
      };
      h[i] = (acceleration(kStep) - acceleration(-kStep)) / (2 * kStep);
    }
    EXPECT_NEAR(deviation[axis], std::sqrt(h.dot(filter_.covariance * h)), 1e-6 * deviation[axis]) << axis;
  }
}

}  // namespace
}  // namespace robot_control
