#include "control/speed_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "signals/command_frame.h"

namespace robot_control {
namespace {

constexpr SpeedLimits kLimits{
    .max_linear_speed = 1, .max_angular_speed = 2, .max_linear_acceleration = 1, .max_angular_acceleration = 4};
constexpr double kDt = 1e-3;
// A speed below 2 rounds to 2·10⁻¹⁶; a difference of two of them over 1 ms shows 10³ times that.
constexpr double kRoundedAcceleration = 1e-12;

TEST(SpeedLimiter, ReachesOneMetrePerSecondInExactlyOneSecond) {
  SpeedLimiter limiter(kLimits);
  for (int k = 1; k <= 1000; ++k) {
    limiter.step({1, 0}, kDt);
    ASSERT_NEAR(limiter.value().linear, k * kDt, 1e-12) << "cycle " << k;  // 1000 roundings
  }
  limiter.step({1, 0}, kDt);
  EXPECT_EQ(limiter.value().linear, 1.0);
  EXPECT_EQ(limiter.step({1, 0}, kDt).linear, 1.0);
  EXPECT_EQ(limiter.acceleration().linear, 0.0);
  EXPECT_EQ(limiter.reasons(), 0u);
}

TEST(SpeedLimiter, NeverExceedsALimitNorOvershoots) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> wish(-4, 4);
    std::uniform_int_distribution<int> hold(1, 800);
    SpeedLimiter limiter(kLimits);
    for (int change = 0; change < 40; ++change) {
      const PlanarTwist target{wish(random), wish(random)};
      const int cycles = hold(random);
      for (int k = 0; k < cycles; ++k) {
        const PlanarTwist before = limiter.value();
        const PlanarTwist after = limiter.step(target, kDt);
        ASSERT_LE(std::abs(after.linear), 1) << "seed " << seed;
        ASSERT_LE(std::abs(after.angular), 2) << "seed " << seed;
        ASSERT_LE(std::abs(after.linear - before.linear) / kDt, 1 + kRoundedAcceleration) << "seed " << seed;
        ASSERT_LE(std::abs(after.angular - before.angular) / kDt, 4 + kRoundedAcceleration) << "seed " << seed;
        // Between where it was and the reachable target: no overshoot, no reversal.
        const double s = std::fmin(1, std::fmin(1 / std::abs(target.linear), 2 / std::abs(target.angular)));
        const auto between = [](double x, double a, double b) {
          return x >= std::fmin(a, b) - 1e-15 && x <= std::fmax(a, b) + 1e-15;
        };
        ASSERT_TRUE(between(after.linear, before.linear, s * target.linear)) << "seed " << seed;
        ASSERT_TRUE(between(after.angular, before.angular, s * target.angular)) << "seed " << seed;
      }
    }
  }
}

TEST(SpeedLimiter, DoesTheSameInReverseBitForBit) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> wish(-3, 3);
    SpeedLimiter forward(kLimits);
    SpeedLimiter reverse(kLimits);
    PlanarTwist target;
    for (int k = 0; k < 5000; ++k) {
      if (k % 250 == 0) target = {wish(random), wish(random)};
      const PlanarTwist ahead = forward.step(target, kDt);
      const PlanarTwist back = reverse.step({-target.linear, -target.angular}, kDt);
      ASSERT_EQ(ahead.linear, -back.linear) << "seed " << seed << " cycle " << k;
      ASSERT_EQ(ahead.angular, -back.angular) << "seed " << seed << " cycle " << k;
      ASSERT_EQ(forward.reasons(), reverse.reasons()) << "seed " << seed << " cycle " << k;
    }
  }
}

TEST(SpeedLimiter, KeepsTheCommandedCurvatureFromStandstillAndBackToIt) {
  SpeedLimiter limiter(kLimits);
  for (const double target : {1.0, 0.0}) {
    for (int k = 0; k < (target > 0 ? 390 : 380); ++k) {
      const PlanarTwist now = limiter.step({target * 0.5, target * 0.2}, kDt);
      ASSERT_NEAR(now.angular, 0.4 * now.linear, 1e-13) << "cycle " << k;
      ASSERT_TRUE(limiter.reasons() & kReasonCurvatureKept);
    }
  }
}

TEST(SpeedLimiter, KeepsTheCurvatureOfATooFastCommandAndSaysSo) {
  SpeedLimiter limiter(kLimits);
  for (int k = 0; k < 2000; ++k) limiter.step({2, 1}, kDt);
  EXPECT_EQ(limiter.value().linear, 1.0);
  EXPECT_EQ(limiter.value().angular, 0.5);
  EXPECT_EQ(limiter.reasons(), kReasonSpeedLimited | kReasonCurvatureKept);
}

TEST(SpeedLimiter, ContinuesFromTheSeedAndReturnsFromAboveTheLimit) {
  SpeedLimiter limiter(kLimits);
  limiter.seed({1.5, 0});
  EXPECT_NEAR(limiter.step({2, 0}, kDt).linear, 1.499, 1e-15);
  for (int k = 0; k < 500; ++k) limiter.step({2, 0}, kDt);
  EXPECT_EQ(limiter.value().linear, 1.0);
}

TEST(SpeedLimiter, TakesALongerStepForASkippedCycle) {
  SpeedLimiter limiter(kLimits);
  EXPECT_NEAR(limiter.step({1, 0}, 3 * kDt).linear, 0.003, 1e-17);
  EXPECT_NEAR(limiter.acceleration().linear, 1, 1e-12);
}

}  // namespace
}  // namespace robot_control
