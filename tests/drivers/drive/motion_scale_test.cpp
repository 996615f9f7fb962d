#include "drivers/drive/mit/motion_scale.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <random>

namespace robot_control::tests {

constexpr MitRanges kRanges{.position = 12.5, .velocity = 50, .torque = 18};
constexpr std::int64_t kSampleNs = 1'000'000;

/// A motor that swings, as its driver sees it: with other ranges, a velocity that is filtered, steps of the protocol,
/// lost and late frames.
struct Motor {
  double amplitude = 0.5;  // rad
  double frequency = 2;    // Hz
  double filter = 0.005;   // s, of the reported velocity
  double loss = 0;
  double late = 0;  // s, at most
  MitRanges ranges = kRanges;

  /// Returns whether a contradiction was found within the time.
  bool is_found(double seconds, MotionScale& scale) const {
    std::mt19937_64 random(3);
    const auto drawn = [&random] { return std::uniform_real_distribution<>(0, 1)(random); };
    double filtered = 0;
    for (std::int64_t now_ns = 0; now_ns < std::llround(1.0e9 * seconds); now_ns += kSampleNs) {
      const double angle = 2 * std::numbers::pi * frequency * 1.0e-9 * static_cast<double>(now_ns);
      const double velocity = amplitude * 2 * std::numbers::pi * frequency * std::cos(angle);
      filtered += (velocity - filtered) * 1.0e-3 / (filter + 1.0e-3);
      if (drawn() < loss) continue;
      const double position = mit_value(mit_raw(amplitude * std::sin(angle), -ranges.position, ranges.position, 16),
                                        -kRanges.position, kRanges.position, 16);
      const double reported =
          mit_value(mit_raw(filtered, -ranges.velocity, ranges.velocity, 12), -kRanges.velocity, kRanges.velocity, 12);
      if (scale.step(position, reported, now_ns + std::llround(1.0e9 * late * drawn()))) return true;
    }
    return false;
  }
  bool is_found(double seconds) const {
    MotionScale scale(kRanges);
    return is_found(seconds, scale);
  }
};

TEST(MotionScale, FindsARangeThatIsWrongByMoreThanItsRatio) {
  for (const double factor : {0.5, 1 / 1.35, 1.35, 2.0, 7.6}) {
    Motor motor;
    motor.ranges.velocity *= factor;
    EXPECT_TRUE(motor.is_found(2)) << factor;
    motor.ranges = kRanges;
    motor.ranges.position *= factor;
    EXPECT_TRUE(motor.is_found(2)) << factor;
  }
}

TEST(MotionScale, FindsNoneWhereTheRangesAreRight) {
  for (const double frequency : {0.05, 0.5, 1.0, 2.0, 4.0}) {
    for (const double amplitude : {0.01, 0.2, 0.7, 1.5}) {
      const Motor motor{.amplitude = amplitude, .frequency = frequency, .loss = 0.05, .late = 0.001};
      EXPECT_FALSE(motor.is_found(600)) << frequency << ' ' << amplitude;
    }
  }
}

TEST(MotionScale, FindsNoneAtRestWithAnOffsetOfTheVelocity) {
  MotionScale scale(kRanges);
  for (std::int64_t i = 0; i < 1'000'000; ++i) ASSERT_FALSE(scale.step(0.3, 0.1, i * kSampleNs));
}

TEST(MotionScale, FindsAPositionThatStaysWithARatioOfZero) {
  MotionScale scale(kRanges);
  bool found = false;
  for (std::int64_t i = 0; i < 2'000 && !found; ++i) found = scale.step(0.3, 5, i * kSampleNs);
  EXPECT_TRUE(found);
  EXPECT_EQ(scale.ratio(), 0);
}

TEST(MotionScale, FindsNoneAtTheEndsOfTheRanges) {
  MotionScale scale(kRanges);
  for (std::int64_t i = 0; i < 10'000; ++i) ASSERT_FALSE(scale.step(12.5, 10, i * kSampleNs));
}

TEST(MotionScale, FindsNoneInASlowTurnByHand) {
  MotionScale scale(kRanges);
  for (std::int64_t i = 0; i < 100'000; ++i) {
    const double time = 1.0e-3 * static_cast<double>(i);
    ASSERT_FALSE(scale.step(0.02 * time, 0.02 - 0.012, i * kSampleNs));
  }
}

}  // namespace robot_control::tests
