// Drives with noise that equals the model of the planar core show whether the error is as large as stated. They also
// show whether the level of the slip noise is found.

#include <Eigen/Cholesky>
#include <deque>

#include "estimation/wheeled/planar/planar_core_fixture.h"
#include "support/positive_definite.h"

namespace robot_control::tests {

/// Wheels slip, a gyro has noise and bias, and a core follows both. A block is 1 s.
class NoisyDrive {
 public:
  NoisyDrive(const PlanarCoreParams& params, double slip, double twist, unsigned seed)
      : params_(params), slip_(slip), twist_(twist), random_(seed), core_(params) {
    bias_ = params.gyro_bias_initial * normal();
    ratio_ = params.ratio_deviation * normal();
    base_ = params.wheel_base_deviation * normal();
    scale_ = params.gyro_scale * normal();
  }

  /// 1 s at `speed` m/s, from the last rate to `rate` rad/s.
  void block(double speed, double rate) {
    constexpr int kSteps = 50;
    double left = 0;
    double right = 0;
    const double slope = (rate - rate_) / kSteps;
    core_.begin_block(rate_);
    for (int i = 0; i < kSteps; ++i) {
      rate_ += slope;
      const auto [left_now, right_now] = step(speed * kStep, (rate_ - slope / 2) * kStep);
      left += left_now;
      right += right_now;
    }
    left += params_.encoder * normal() * std::sqrt(2.0);
    right += params_.encoder * normal() * std::sqrt(2.0);
    core_.end_block({.time = 1.0, .left = left, .right = right, .rate = rate_});
  }

  /// Sets the steps by which the wheels are read later than the gyro.
  void delay_wheels(int steps) { late_.assign(static_cast<std::size_t>(steps), {0, 0}); }

  /// Normalised estimation error squared of x, y and yaw.
  double nees() const {
    const Eigen::Vector3d error(core_.pose().x - truth_.x, core_.pose().y - truth_.y, core_.pose().yaw - truth_.yaw);
    const Eigen::Matrix3d known = (*core_.covariance()).block<3, 3>(PlanarCore::kX, PlanarCore::kX);
    return error.dot(known.llt().solve(error));
  }

  const PlanarCore& core() const { return core_; }
  double bias() const { return bias_; }

  static constexpr double kStep = 0.02;  // s

 private:
  double normal() { return normal_(random_); }

  /// m, of either side, as read in this step.
  std::pair<double, double> step(double travel, double turn) {
    truth_.x += travel * std::cos(truth_.yaw + turn / 2);
    truth_.y += travel * std::sin(truth_.yaw + turn / 2);
    truth_.yaw += turn;
    // The treads roll with the turn that the contacts do not follow, and with the slip of either side.
    const double turned = params_.wheel_base * (1 + base_) * (turn + twist_ * std::sqrt(std::abs(turn)) * normal());
    const double rolled_left = travel - turned / 2;
    const double rolled_right = travel + turned / 2;
    const double slipped_left = slip_ * std::sqrt(std::abs(rolled_left)) * normal();
    const double slipped_right = slip_ * std::sqrt(std::abs(rolled_right)) * normal();
    late_.emplace_back((rolled_left + slipped_left) * (1 + ratio_ / 2),
                       (rolled_right + slipped_right) * (1 - ratio_ / 2));
    const auto read = late_.front();
    late_.pop_front();
    const double measured = turn / (1 + scale_) + bias_ * kStep + params_.gyro_noise * std::sqrt(kStep) * normal();
    const double before = core_.pose().yaw;
    core_.turn_by_gyro(measured, kStep);
    const double middle = (before + core_.pose().yaw) / 2 - rate_ * core_.offset();
    const double ahead = (read.first + read.second) / 2 + core_.ratio() * (read.second - read.first) / 4;
    const double aside = slip_ / std::sqrt(2.0) * std::sqrt(std::abs(travel)) * normal();
    core_.roll(std::cos(middle) * ahead - std::sin(middle) * aside, std::sin(middle) * ahead + std::cos(middle) * aside,
               rate_);
    return read;
  }

  PlanarCoreParams params_;
  double slip_, twist_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0, 1};
  PlanarCore core_;
  PlanarPose truth_;
  std::deque<std::pair<double, double>> late_;  ///< m, of either side, not yet read
  double rate_ = 0;                             ///< rad/s
  double bias_ = 0, ratio_ = 0, base_ = 0, scale_ = 0;
};

/// Straight, left, right, straight, of 4 s each.
void drive_legs(NoisyDrive& drive, int blocks) {
  for (int i = 0; i < blocks; ++i) {
    const double rates[] = {0, 0.4, -0.3, 0};  // rad/s
    drive.block(0.5, rates[i / 4 % 4]);
  }
}

constexpr double kSlipNoise = 5e-3;  // m/√m, with which the core begins

// Each drive takes a minute; the yaw stays so well known that the error is linear. The mean of 200 χ² of 3 degrees of
// freedom has the 95 % band 3 ± 1.96 √(2·3/200).
TEST(CoreConsistency, TheErrorIsAsLargeAsStatedWhereTheSlipNoiseIsKnown) {
  constexpr int kDrives = 200;
  double sum = 0;
  for (unsigned seed = 0; seed < kDrives; ++seed) {
    NoisyDrive drive({.gyro_bias_initial = 1e-3, .slip_least = kSlipNoise, .clock_offset = 0}, kSlipNoise, 5e-4, seed);
    drive_legs(drive, 60);
    sum += drive.nees();
  }
  EXPECT_NEAR(sum / kDrives, 3, 1.96 * std::sqrt(2 * 3.0 / kDrives));
}

// The learned level scatters by σ = 0.34 of its logarithm u, the stationary deviation of its steps of 0.2. Updates that
// are weighted by exp(−2u) make the error of the bias exp(6 σ²) = 2.0 times as large as stated, squared; the band is
// that of 200 χ² of one degree of freedom.
TEST(CoreConsistency, ALearnedSlipNoiseCostsNoMoreThanItsScatter) {
  constexpr int kDrives = 200;
  double sum = 0;
  for (unsigned seed = 0; seed < kDrives; ++seed) {
    NoisyDrive drive({.gyro_bias_initial = 1e-3, .clock_offset = 0}, kSlipNoise, 0.05, seed);
    drive_legs(drive, 200);
    const double error = drive.core().bias() - drive.bias();
    sum += error * error / drive.core().bias_variance();
  }
  EXPECT_LT(sum / kDrives, 2.0 * (1 + 1.96 * std::sqrt(2.0 / kDrives)));
}

// Readings of the wheels are late by τ. The rates at the ends of a block give τ only to the first order. If the rate
// changes by α, α τ²/2 is left of α τ, 5 % at 0.1 s.
TEST(CoreConsistency, TheClockOffsetIsFound) {
  for (const int steps : {0, 1, 5}) {
    const double late = steps * NoisyDrive::kStep;
    NoisyDrive drive({.gyro_bias_initial = 1e-3}, 1e-3, 0, 1);
    drive.delay_wheels(steps);
    for (int i = 0; i < 60; ++i) drive.block(0.5, i % 4 < 2 ? 0.6 : -0.6);
    const double deviation = drive.core().deviation(PlanarCore::kOffset);
    EXPECT_NEAR(drive.core().offset(), late, 3 * deviation + late * late / 2) << steps;
    EXPECT_LT(deviation, 0.004) << steps;  // it walks by 2 ms in a second
  }
}

/// m/√m: geometric mean of the learned slip noise in the last 50 of 150 blocks straight on.
double learned(double slip, unsigned seed) {
  NoisyDrive drive({.gyro_bias_initial = 0, .clock_offset = 0}, slip, 0, seed);
  double sum = 0;
  for (int i = 0; i < 150; ++i) {
    drive.block(0.5, 0);
    if (i >= 100) sum += std::log(drive.core().slip());
  }
  return std::exp(sum / 50);
}

class CoreSlipNoise : public testing::TestWithParam<double> {};

// The mean is taken over ten drives. The gyro's noise and the uncertain turn slip explain a part of it, so it never
// exceeds the whole.
TEST_P(CoreSlipNoise, IsThatOfTheFloor) {
  double sum = 0;
  for (unsigned seed = 0; seed < 10; ++seed) sum += std::log(learned(GetParam(), seed)) / 10;
  EXPECT_LT(std::exp(sum), 1.1 * GetParam());
  EXPECT_GT(std::exp(sum), 0.7 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(Floors, CoreSlipNoise, testing::Values(2e-3, 5e-3, 1.6e-2));

TEST(CoreConsistency, TheSlipNoiseBeginsPessimisticAndFallsToTheLeast) {
  PlanarCore core{PlanarCoreParams{}};
  EXPECT_EQ(core.slip(), kSlipNoise);
  core.rest(0, 1e-8, false);
  practise(core, 5);
  EXPECT_LT(core.slip(), kSlipNoise);
  practise(core, 400);
  EXPECT_EQ(core.slip(), PlanarCoreParams{}.slip_least);
}

// This holds for any operations in any order.
TEST(CoreConsistency, TheCovarianceIsNeverNegative) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    PlanarCore core{PlanarCoreParams{}};
    for (int i = 0; i < 3000; ++i) {
      switch (random() % 12) {
        case 0:
          core.place({any(random), any(random), any(random)});
          break;
        case 1:
          core.set_bias(0.01 * any(random), 0.01);
          break;
        case 2:
          core.rest(0.01 * any(random), 1e-7, random() % 2 == 0);
          break;
        case 3:
          core.turn_by_wheels(any(random), any(random), 0.1 * any(random));
          break;
        case 4:
          core.begin_block(any(random));
          break;
        case 5:
          core.end_block({.time = 0.5, .left = any(random), .right = any(random), .rate = any(random)});
          break;
        case 6:
          core.shift(any(random), any(random), 1e-4);
          break;
        case 7:
          core.open_bias(1e-4);
          break;
        default:
          core.turn_by_gyro(any(random), 0.1);
          core.roll(any(random), any(random), any(random));
      }
      const CoreMatrix p = *core.covariance();
      ASSERT_EQ((p - p.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * p.cwiseAbs().maxCoeff(), true) << seed << ' ' << i;
      ASSERT_GE(p.diagonal().minCoeff(), 0) << "seed " << seed << ", step " << i;
      ASSERT_TRUE(positive_definite(p, PlanarCore::kSize, 1e-9)) << "seed " << seed << ", step " << i;
    }
  }
}

}  // namespace robot_control::tests
