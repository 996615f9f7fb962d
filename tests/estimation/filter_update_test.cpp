// What corrections, events and refusals do to nominal state and covariance.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstring>
#include <random>

#include "estimation/filter_errors.h"
#include "support/allocation_guard.h"
#include "support/constants.h"

namespace robot_control {
namespace {

using Filter = ErrorStateFilter;
using Eigen::Vector3d;
const ContactGeometry kGeometry{
    .wheel_base = 0.5, .middle_y = 0.02, .middle_x = -0.2, .height = -0.3, .imu_in_base = {0.2, -0.02, 0.3}};

bool same(const Filter& a, const Filter& b) {
  return a.position == b.position && a.rotation == b.rotation && a.velocity == b.velocity && a.travel == b.travel &&
         a.gyro_bias == b.gyro_bias && a.accelerometer_bias == b.accelerometer_bias &&
         a.radius_ratio == b.radius_ratio && a.wheel_base == b.wheel_base && a.gyro_scale == b.gyro_scale &&
         a.covariance == b.covariance && a.corrections() == b.corrections();
}

double smallest_eigenvalue(const Filter::Covariance& covariance) {
  // Scaled to a correlation: a bias and a position are of different sizes.
  const Filter::Column scale = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Filter::Covariance correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Filter::Covariance>(correlation).eigenvalues().minCoeff();
}

/// Ten seconds of a level drive at 0.5 m/s with a swinging turn, exact sensors, all measurements.
class FilterUpdate : public testing::Test {
 protected:
  FilterUpdate() { drive(10000); }

  Filter::Motion motion_at(int k) const {
    Filter::Motion motion;
    motion.dt = kPeriod;
    const double rate = 0.5 * std::sin(k * kPeriod);
    const double slope = 0.5 * std::cos(k * kPeriod);
    const Vector3d contact{kGeometry.middle_x, kGeometry.middle_y, kGeometry.height};
    const Vector3d omega{0, 0, rate};
    const Vector3d velocity = Vector3d(0.5, 0, 0) - omega.cross(contact);
    const Vector3d change = -Vector3d(0, 0, slope).cross(contact);
    motion.gyro = omega;
    motion.accelerometer = change + omega.cross(velocity) + Vector3d(0, 0, Filter::kGravity);
    motion.left_speed = 0.5 - 0.25 * rate;
    motion.right_speed = 0.5 + 0.25 * rate;
    motion.left_travel = motion.left_speed * kPeriod;
    motion.right_travel = motion.right_speed * kPeriod;
    return motion;
  }
  void drive(int cycles) {
    if (cycle_ == 0) {
      filter_.velocity = Vector3d(0.5, 0, 0);
      for (const int i : {0, 1, 2}) filter_.covariance(Filter::kVelocity + i, Filter::kVelocity + i) = 1e-4;
    }
    for (int i = 0; i < cycles; ++i) {
      const Filter::Motion motion = motion_at(cycle_++);
      filter_.predict(motion);
      travel_ += Eigen::Vector2d(motion.left_travel, motion.right_travel);
      for (const int side : {0, 1}) EXPECT_TRUE(filter_.correct_travel(side, travel_[side]).used) << cycle_;
      EXPECT_TRUE(filter_.correct_lateral(kPeriod).used) << cycle_;
      EXPECT_TRUE(filter_.correct_vertical(kPeriod).used) << cycle_;
    }
  }
  double deviation(int index) const { return std::sqrt(filter_.covariance(index, index)); }

  Filter filter_{kGeometry, {}, {}};
  Eigen::Vector2d travel_{0, 0};
  int cycle_ = 0;
};

// An asymmetric part is never measured: begun by rounding it would have grown to 10⁻⁵ of the variances by now.
TEST_F(FilterUpdate, TheCovarianceStaysSymmetricAndPositive) {
  drive(90000);
  EXPECT_EQ(filter_.covariance, filter_.covariance.transpose());
  EXPECT_GT(smallest_eigenvalue(filter_.covariance), 0);
}

// Every order of every measurement, with and without sensors, for 20 000 steps.
TEST(FilterProperties, RandomStepsLeaveTheCovariancePositive) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 1);
    Filter filter(kGeometry, {}, {});
    for (int k = 0; k < 20000; ++k) {
      Filter::Motion motion;
      motion.dt = kPeriod * (1 + static_cast<double>(random() % 20));
      const auto vector = [&](double size) {
        const double x = normal(random), y = normal(random), z = normal(random);
        return Vector3d(size * x, size * y, size * z);
      };
      if (random() % 4 != 0) motion.gyro = vector(1);
      if (random() % 4 != 0) {
        motion.accelerometer = vector(1) + filter.rotation.transpose() * Vector3d(0, 0, Filter::kGravity);
      }
      motion.left_speed = normal(random);
      motion.right_speed = normal(random);
      motion.left_travel = motion.left_speed * motion.dt;
      motion.right_travel = motion.right_speed * motion.dt;
      filter.predict(motion);
      const int side = static_cast<int>(random() % 2);
      const int axis = static_cast<int>(random() % 3);
      switch (random() % 9) {
        case 0:
          filter.correct_travel(side, filter.travel[side] + 1e-4 * normal(random));
          break;
        case 1:
          filter.correct_lateral(motion.dt);
          break;
        case 2:
          filter.correct_vertical(motion.dt);
          break;
        case 3:
          filter.correct_gyro_at_rest(axis, filter.gyro_bias[axis] + 1e-3 * normal(random), 1e-7,
                                      random() % 2 == 0 ? Filter::Rest::kBegins : Filter::Rest::kGoesOn);
          break;
        case 4:
          filter.correct_accelerometer_at_rest(axis, normal(random), 1e-4);
          break;
        case 5:
          filter.anchor_travel(side, normal(random));
          break;
        case 6:
          filter.inflate_velocity(axis, 0.1, 0.1);
          break;
        case 7:
          filter.halt(0.01);
          break;
        default:
          filter.stand(0.01);
          break;
      }
      if (k % 100 != 0) continue;
      ASSERT_TRUE(filter.covariance.allFinite()) << "seed " << seed << " step " << k;
      const Filter::Column diagonal = filter.covariance.diagonal();
      ASSERT_GE(diagonal.minCoeff(), 0) << "seed " << seed << " step " << k;
      const Filter::Covariance skew = filter.covariance - filter.covariance.transpose();
      ASSERT_EQ(skew, Filter::Covariance::Zero()) << "seed " << seed << " step " << k;
      ASSERT_GT(smallest_eigenvalue(filter.covariance), -1e-9) << "seed " << seed << " step " << k;
      const Eigen::Matrix3d& r = filter.rotation;
      ASSERT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 1e-9) << "seed " << seed;
    }
  }
}

// The gate stands at 4 σ of the innovation.
TEST_F(FilterUpdate, AnOutlierIsRefusedAndLeavesNoTrace) {
  Filter trial = filter_;
  trial.velocity.y() += 1e-3;
  const double sigma = 1e-3 / std::sqrt(trial.correct_lateral(kPeriod).nis);
  filter_.velocity.y() += 5 * sigma;
  const Filter before = filter_;
  const auto refused = filter_.correct_lateral(kPeriod);
  EXPECT_FALSE(refused.used);
  EXPECT_NEAR(refused.nis, 25, 1);  // the lateral speed was not exactly zero before
  EXPECT_TRUE(same(filter_, before));
  filter_.velocity.y() -= 1.1 * sigma;
  EXPECT_TRUE(filter_.correct_lateral(kPeriod).used);
}

TEST_F(FilterUpdate, WhatIsNotANumberIsRefused) {
  const Filter before = filter_;
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) EXPECT_FALSE(filter_.correct_travel(1, bad).used);
  EXPECT_TRUE(same(filter_, before));
}

// A scalar measurement: the variance of what is measured becomes P r/(P + r), no other grows but that of the IMU's
// place, which goes with the orientation so that base_link stays.
TEST_F(FilterUpdate, AMeasurementShrinksVarianceByTheKalmanGain) {
  const Filter::Covariance before = filter_.covariance;
  const double p = before(Filter::kGyroBias, Filter::kGyroBias);
  const double r = 0.3 * p;
  filter_.correct_gyro_at_rest(0, filter_.gyro_bias[0], r, Filter::Rest::kBegins);
  EXPECT_NEAR(filter_.covariance(Filter::kGyroBias, Filter::kGyroBias), p * r / (p + r), 1e-9 * p);
  for (int i = Filter::kOrientation; i < Filter::kSize; ++i) EXPECT_LE(filter_.covariance(i, i), before(i, i)) << i;
}

// A wheel that may be sliding tells where it is, not what radius it has, nor what the gyro's bias is.
TEST_F(FilterUpdate, AWheelInDoubtCorrectsMotionAlone) {
  Filter believed = filter_;
  Filter doubted = filter_;
  believed.correct_travel(0, filter_.travel[0] + 1e-4);
  doubted.correct_travel(0, filter_.travel[0] + 1e-4, Filter::Scope::kMotion);
  EXPECT_NE(believed.radius_ratio, filter_.radius_ratio);
  EXPECT_NE(believed.wheel_base, filter_.wheel_base);
  EXPECT_NE(believed.gyro_bias, filter_.gyro_bias);
  EXPECT_EQ(doubted.radius_ratio, filter_.radius_ratio);
  EXPECT_EQ(doubted.wheel_base, filter_.wheel_base);
  EXPECT_EQ(doubted.gyro_bias, filter_.gyro_bias);
  EXPECT_EQ(doubted.velocity, believed.velocity);
  EXPECT_EQ(doubted.travel, believed.travel);
  for (const int i : {+Filter::kRadiusRatio, +Filter::kWheelBase, Filter::kGyroBias + 2}) {
    EXPECT_EQ(doubted.covariance(i, i), filter_.covariance(i, i)) << i;
  }
}

// An uneven floor breaks this contact all the time: position, orientation and what is learned stay.
TEST_F(FilterUpdate, TheVerticalContactCorrectsVelocityAndTravelAlone) {
  filter_.predict(motion_at(cycle_));
  filter_.velocity.z() += 1e-3;
  ASSERT_TRUE(filter_.correct_vertical(kPeriod).used);
  EXPECT_NE(filter_.corrections()[Filter::kVelocity + 2], 0);
  for (int i = 0; i < Filter::kSize; ++i) {
    if (i >= Filter::kVelocity && i <= Filter::kTravel + 1) continue;
    EXPECT_EQ(filter_.corrections()[i], 0) << i;
  }
}

TEST_F(FilterUpdate, ABodyThatRocksTurnsAboutItsContacts) {
  const ContactGeometry& g = filter_.geometry();
  const Vector3d turning{0.1, -0.2, 0.3};
  const double before = filter_.covariance(Filter::kVelocity, Filter::kVelocity);
  filter_.rock(turning, 0.01);
  const Vector3d contact = filter_.velocity + turning.cross(Vector3d(g.middle_x, g.middle_y, g.height));
  EXPECT_LT(contact.norm(), 1e-15);
  EXPECT_EQ(filter_.rate, turning);
  EXPECT_GT(filter_.covariance(Filter::kVelocity, Filter::kVelocity), before);
}

// At rest the tilt is learned about base_link: the IMU moves on its lever, base_link does not.
TEST_F(FilterUpdate, WhatIsLearnedAtRestLeavesTheBaseWhereItIs) {
  const auto base = [&] { return Vector3d(filter_.position - filter_.rotation * kGeometry.imu_in_base); };
  const Vector3d before = base();
  const Eigen::Matrix3d level = filter_.rotation;
  for (const int axis : {0, 1, 2}) filter_.correct_accelerometer_at_rest(axis, axis == 2 ? 9.8 : 0.05, 1e-3);
  EXPECT_GT((filter_.rotation - level).norm(), 1e-3);
  EXPECT_LT((base() - before).norm(), 1e-5);
}

TEST_F(FilterUpdate, CorrectionsAreWhatWasInjectedSinceThePrediction) {
  filter_.predict(motion_at(cycle_));
  EXPECT_EQ(filter_.corrections(), Filter::Column::Zero());
  const Filter predicted = filter_;
  filter_.correct_travel(0, filter_.travel[0] + 2e-5);
  filter_.correct_lateral(kPeriod);
  const Filter::Column moved = error_between(predicted, filter_);
  EXPECT_LT((moved - filter_.corrections()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(filter_.corrections().norm(), 0);
}

TEST_F(FilterUpdate, WhatIsInjectedIsTakenBackByItsNegative) {
  const Filter before = filter_;
  Filter::Column error = Filter::Column::Constant(1e-3);
  filter_.inject(error);
  EXPECT_GT(error_between(before, filter_).norm(), 1e-3);
  filter_.inject(-error);
  EXPECT_LT(error_between(before, filter_).cwiseAbs().maxCoeff(), 1e-15 * 10);
}

// However far a correction pulls, wheels of one type differ by no more than the bounds.
TEST_F(FilterUpdate, TheCalibrationKeepsItsBounds) {
  Filter::Column far = Filter::Column::Zero();
  far[Filter::kRadiusRatio] = far[Filter::kWheelBase] = far[Filter::kGyroScale] = 10;
  filter_.inject(far);
  EXPECT_LE(filter_.radius_ratio, 0.1);
  EXPECT_LE(filter_.wheel_base, 0.5);
  EXPECT_LE(filter_.gyro_scale, 0.1);
  const double ratio = filter_.radius_ratio;
  filter_.inject(-2 * far);
  EXPECT_EQ(filter_.radius_ratio, -ratio);
}

TEST_F(FilterUpdate, StandingKnowsOnlyTheVelocityAnew) {
  const Filter before = filter_;
  filter_.stand(0.02);
  EXPECT_EQ(filter_.velocity, Vector3d::Zero());
  EXPECT_EQ(filter_.rate, Vector3d::Zero());
  EXPECT_EQ(filter_.position, before.position);
  for (int i = 0; i < Filter::kSize; ++i) {
    for (int j = 0; j < Filter::kSize; ++j) {
      const bool velocity_i = i >= Filter::kVelocity && i < Filter::kVelocity + 3;
      const bool velocity_j = j >= Filter::kVelocity && j < Filter::kVelocity + 3;
      const double expected = velocity_i || velocity_j ? (i == j ? 4e-4 : 0) : before.covariance(i, j);
      EXPECT_EQ(filter_.covariance(i, j), expected) << i << " by " << j;
    }
  }
}

// Of three components only x is wrong: P_px/(P_xx + r) of it pulls the position, y and z follow by what x moved them.
TEST_F(FilterUpdate, ComingToRestTellsWhereTheVelocityWentWrongOnTheWay) {
  constexpr double kWrong = 0.004;  // m/s
  constexpr double kDeviation = 0.01;
  constexpr int v = Filter::kVelocity;
  filter_.covariance.setZero();
  for (const int i : {0, 1, 2}) {
    filter_.covariance(v + i, v + i) = filter_.covariance(i, i) = 1e-4;
    filter_.covariance(v + i, i) = filter_.covariance(i, v + i) = 0.6e-4;
  }
  filter_.velocity = {kWrong, 0, 0};
  const Vector3d before = filter_.position;
  filter_.halt(kDeviation);
  EXPECT_EQ(filter_.velocity, Vector3d::Zero());
  EXPECT_NEAR(filter_.position.x() - before.x(), -kWrong * 0.6e-4 / (1e-4 + kDeviation * kDeviation), 1e-15);
  EXPECT_EQ(filter_.position.y(), before.y());
  EXPECT_NEAR(filter_.covariance(0, 0), 1e-4 - 0.36e-8 / 2e-4, 1e-15);
  EXPECT_NEAR(filter_.covariance(v, v), kDeviation * kDeviation, 1e-15);
}

TEST_F(FilterUpdate, BiasesWalkWhileNothingIsPredicted) {
  const Filter before = filter_;
  filter_.age(100);
  for (const int i : {0, 1, 2}) {
    const int g = Filter::kGyroBias + i;
    const int a = Filter::kAccelerometerBias + i;
    EXPECT_DOUBLE_EQ(filter_.covariance(g, g), before.covariance(g, g) + 1e-10 * 100);
    EXPECT_DOUBLE_EQ(filter_.covariance(a, a), before.covariance(a, a) + 1e-8 * 100);
  }
  EXPECT_EQ(filter_.gyro_bias, before.gyro_bias);
}

TEST_F(FilterUpdate, AnAnchoredTravelIsAsGoodAsAReading) {
  filter_.anchor_travel(1, 42);
  EXPECT_EQ(filter_.travel[1], 42);
  const int index = Filter::kTravel + 1;
  for (int i = 0; i < Filter::kSize; ++i) {
    const double expected = i == index ? filter_.noise().encoder * filter_.noise().encoder : 0;
    EXPECT_EQ(filter_.covariance(i, index), expected) << i;
    EXPECT_EQ(filter_.covariance(index, i), expected) << i;
  }
}

// δ m/s along an axis for t s: position is off by δ t/2 along it in the mean, fully correlated.
TEST_F(FilterUpdate, ADoubtedVelocityIsAWayGoneWrong) {
  const Filter before = filter_;
  filter_.inflate_velocity(0, 0.3, 2.0);
  const Filter::Covariance grown = filter_.covariance - before.covariance;
  const int v = Filter::kVelocity;
  EXPECT_NEAR(grown(v, v), 0.09, 1e-12);
  const Vector3d way = filter_.rotation.col(0) * 0.3 * 2.0 / 2;
  EXPECT_LT((grown.block<3, 3>(0, 0) - way * way.transpose()).norm(), 1e-12);
  EXPECT_LT((grown.block<3, 1>(0, v) - way * 0.3).norm(), 1e-12);
  EXPECT_EQ(grown(v + 1, v + 1), 0);
  EXPECT_GT(filter_.covariance(Filter::kAccelerometerBias, Filter::kAccelerometerBias),
            Filter::kPulledBias * Filter::kPulledBias);
  EXPECT_EQ(filter_.velocity, before.velocity);
}

TEST_F(FilterUpdate, AResetForgetsEverything) {
  filter_.reset();
  EXPECT_TRUE(same(filter_, Filter(kGeometry, {}, {})));
}

TEST_F(FilterUpdate, StepsWithoutAllocating) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  const AllocationGuard guard;
  drive(100);
  filter_.inflate_velocity(0, 0.1, 0.1);
  filter_.halt(0.01);
  filter_.stand(0.01);
  static_cast<void>(filter_.acceleration_deviation());
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace robot_control
