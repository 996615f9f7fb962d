#include "control/wheeled/limits/speed_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/wheeled/limits/limiter_properties.h"
#include "signals/command_frame.h"

namespace robot_control::tests {

constexpr SpeedLimits kLimits{
    .linear = {.speed = 1, .acceleration = 1, .deceleration = 1, .emergency_deceleration = 2},
    .angular = {.speed = 2, .acceleration = 4, .deceleration = 4, .emergency_deceleration = 8},
};
constexpr SpeedLimits kSmooth{
    .linear = {.speed = 1, .acceleration = 1, .deceleration = 1.5, .emergency_deceleration = 3, .jerk = 10},
    .angular = {.speed = 2, .acceleration = 4, .deceleration = 6, .emergency_deceleration = 12, .jerk = 40},
};
constexpr double kDt = 1e-3;

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

TEST(SpeedLimiter, KeepsTheCurvatureOfATooFastCommandAndSaysSo) {
  SpeedLimiter limiter(kLimits);
  for (int k = 0; k < 2000; ++k) limiter.step({2, 1}, kDt);
  EXPECT_EQ(limiter.value().linear, 1.0);
  EXPECT_EQ(limiter.value().angular, 0.5);
  EXPECT_EQ(limiter.reasons(), std::uint64_t{kReasonSpeedLimited} | kReasonCurvatureKept);
  for (int k = 0; k < 2000; ++k) limiter.step({2, 0}, kDt);
  EXPECT_EQ(limiter.reasons(), std::uint64_t{kReasonSpeedLimited}) << "it is straight";
}

TEST(SpeedLimiter, ScalesACommandIntoTheLimitsOfEitherAxisAndDirection) {
  for (const double linear : {1.0, -1.0}) {
    for (const double angular : {1.0, -1.0}) {
      const PlanarTwist fast = within_speed({4 * linear, 2 * angular}, kLimits);
      EXPECT_EQ(fast.linear, linear) << "of 1 m/s";
      EXPECT_EQ(fast.angular, 0.5 * angular);
      const PlanarTwist turning = within_speed({0.5 * linear, 8 * angular}, kLimits);
      EXPECT_EQ(turning.linear, 0.125 * linear);
      EXPECT_EQ(turning.angular, 2 * angular) << "of 2 rad/s";
    }
  }
}

TEST(SpeedLimiter, HasNoReasonBeforeItsFirstStepAndAfterARestart) {
  SpeedLimiter limiter(kLimits);
  EXPECT_EQ(limiter.reasons(), 0U);
  limiter.step({2, 0}, kDt);
  EXPECT_NE(limiter.reasons(), 0U);
  limiter.restart_from({});
  EXPECT_EQ(limiter.reasons(), 0U);
}

TEST(SpeedLimiter, ContinuesFromTheSeedAndReturnsFromAboveTheLimit) {
  SpeedLimiter limiter(kLimits);
  limiter.restart_from({1.5, 0});
  EXPECT_NEAR(limiter.step({2, 0}, kDt).linear, 1.499, 1e-15);
  for (int k = 0; k < 500; ++k) limiter.step({2, 0}, kDt);
  EXPECT_EQ(limiter.value().linear, 1.0);
}

TEST(SpeedLimiter, TakesALongerStepForASkippedCycle) {
  SpeedLimiter limiter(kLimits);
  EXPECT_NEAR(limiter.step({1, 0}, 3 * kDt).linear, 0.003, 1e-17);
  EXPECT_NEAR(limiter.acceleration().linear, 1, 1e-12);
}

TEST(SpeedLimiter, ViolatesNoPropertyInTenThousandRandomSequences) {
  for (std::uint64_t seed = 0; seed < 10'000; ++seed) {
    const auto violated = limiter_violation(seed);
    ASSERT_FALSE(violated) << "seed " << seed << ": " << *violated;
  }
}

// A step that reached the target by rounding alone left an acceleration that led away from it in the next one. One
// sequence in a million shows it.
TEST(SpeedLimiter, StaysAtATargetThatItReachedByRounding) {
  EXPECT_EQ(limiter_violation(5'712'238).value_or(""), "");
}

/// Cycles until `limiter` is at `target`.
int cycles_to(SpeedLimiter& limiter, const PlanarTwist& target, bool emergency = false) {
  for (int k = 1; k < 100'000; ++k) {
    const PlanarTwist now = limiter.step(target, kDt, emergency);
    if (now.linear == target.linear && now.angular == target.angular) return k;
  }
  return -1;
}

// A ramp of v takes v/a + a/j; a sampled one acts from its first step on, and needs one step less.
TEST(SpeedLimiter, TakesTheTimeOfTheIdealSCurve) {
  SpeedLimiter limiter(kSmooth);
  EXPECT_NEAR(cycles_to(limiter, {1, 0}), 1000 * (1 / 1.0 + 1.0 / 10), 1);
  EXPECT_NEAR(cycles_to(limiter, {0, 0}), 1000 * (1 / 1.5 + 1.5 / 10), 1);
  EXPECT_NEAR(cycles_to(limiter, {0.02, 0}), 1000 * 2 * std::sqrt(0.02 / 10), 1) << "too short for full acceleration";
  EXPECT_NEAR(cycles_to(limiter, {1, 0}), 1000 * (0.98 / 1.0 + 1.0 / 10), 1);
  EXPECT_NEAR(cycles_to(limiter, {0, 0}, true), 1000 * (1 / 3.0 + 3.0 / 10), 1);
}

// It takes v/1.5 until zero and v/1 beyond it. The deceleration falls from 1.5 to 1 m/s² within 0.05 s before zero, in
// which 0.0625 m/s pass.
TEST(SpeedLimiter, ReversesWithoutStoppingAndWithEachLimitOnItsSideOfZero) {
  SpeedLimiter limiter(kSmooth);
  cycles_to(limiter, {1, 0});
  const double before_zero = 1.5 / 10 / 2 + (1 - 0.0625) / 1.5 + 0.05;
  const double beyond_zero = 1 / 1.0 + 1.0 / 10 / 2;
  EXPECT_NEAR(cycles_to(limiter, {-1, 0}), 1000 * (before_zero + beyond_zero), 3);
}

TEST(SpeedLimiter, SaysWhichLimitShapesTheMotion) {
  SpeedLimiter limiter(kSmooth);
  limiter.step({1, 0}, kDt);
  EXPECT_EQ(limiter.reasons(), kReasonJerkLimited);
  for (int k = 0; k < 200; ++k) limiter.step({1, 0}, kDt);
  EXPECT_EQ(limiter.reasons(), kReasonAccelerationLimited);
  while (limiter.value().linear < 0.99) limiter.step({1, 0}, kDt);
  EXPECT_EQ(limiter.reasons(), kReasonJerkLimited);
  cycles_to(limiter, {1, 0});
  limiter.step({1, 0}, kDt);
  EXPECT_EQ(limiter.reasons(), 0u);
}

// Both axes have the shape of the slower one: 1 m/s needs 1.1 s, 1 rad/s alone would need 0.35 s.
TEST(SpeedLimiter, KeepsTheCurvatureUnderAJerkLimit) {
  SpeedLimiter limiter(kSmooth);
  for (const double target : {1.0, 0.0}) {
    int k = 0;
    for (; limiter.value().linear != target && k < 2000; ++k) {
      const PlanarTwist now = limiter.step({target, target}, kDt);
      ASSERT_NEAR(now.angular, now.linear, 1e-12) << "cycle " << k;
    }
    EXPECT_EQ(limiter.value().angular, target);
    EXPECT_NEAR(k, target > 0 ? 1100 : 817, 1);
  }
}

TEST(SpeedLimiter, LetsEachAxisHurryWhereCurvatureNeedNotBeKept) {
  SpeedLimits limits = kSmooth;
  limits.keep_curvature = false;
  SpeedLimiter limiter(limits);
  int turned = 0;
  for (int k = 1; limiter.value().linear != 1; ++k) {
    limiter.step({1, 1}, kDt);
    if (turned == 0 && limiter.value().angular == 1) turned = k;
    ASSERT_FALSE(limiter.reasons() & kReasonCurvatureKept);
  }
  EXPECT_NEAR(turned, 1000 * (1 / 4.0 + 4.0 / 40), 1);
}

TEST(SpeedLimiter, ReturnsFromLimitsThatWereLowered) {
  SpeedLimiter limiter(kSmooth);
  cycles_to(limiter, {1, 0});
  SpeedLimits lower = kSmooth;
  lower.linear.speed = 0.4;
  limiter.set_limits(lower);
  double before = 1;
  for (int k = 0; k < 2000; ++k) {
    const double now = limiter.step({1, 0}, kDt).linear;
    ASSERT_LE(before - now, 1.5 * kDt + 1e-12);
    before = now;
  }
  EXPECT_EQ(before, 0.4);
}

// The machine follows only a part of the acceleration, another one in every cycle. The tighter jerk limit of both axes
// holds: in the second case that of the linear axis.
TEST(SpeedLimiter, APartOfTheLimitsKeepsLineAndJerk) {
  SpeedLimits gentle = kSmooth;
  gentle.linear.acceleration = gentle.linear.deceleration = 2;
  gentle.linear.jerk = 8;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const SpeedLimits& limits = seed % 2 == 0 ? kSmooth : gentle;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(0.01, 1);
    SpeedLimiter limiter(limits);
    PlanarTwist last;
    for (int k = 0; k < 6000; ++k) {
      const PlanarTwist goal = k < 3000 ? PlanarTwist{0.9, 1.5} : PlanarTwist{};
      limiter.step(goal, kDt, false, part(random));
      ASSERT_NEAR(1.5 * limiter.value().linear, 0.9 * limiter.value().angular, 1e-12) << "seed " << seed;
      const PlanarTwist& a = limiter.acceleration();
      ASSERT_LE(std::abs(a.linear - last.linear), limits.linear.jerk * kDt * (1 + 1e-9)) << "seed " << seed;
      ASSERT_LE(std::abs(a.angular - last.angular), limits.angular.jerk * kDt * (1 + 1e-9)) << "seed " << seed;
      last = a;
    }
    ASSERT_EQ(limiter.value().linear, 0.0) << "seed " << seed;
  }
}

TEST(SpeedLimiter, HalfOfTheLimitsTakesTwiceAsLong) {
  for (const PlanarTwist& target : {PlanarTwist{1, 0}, PlanarTwist{-1, 0}, PlanarTwist{0, 2}, PlanarTwist{0, -2}}) {
    SpeedLimiter limiter(kLimits);
    const double cycles = target.linear != 0 ? 2000 : 1000;
    for (int k = 1; k <= cycles; ++k) limiter.step(target, kDt, false, 0.5);
    EXPECT_NEAR(limiter.value().linear, target.linear, 1e-12);  // 2000 roundings
    EXPECT_NEAR(limiter.value().angular, target.angular, 1e-12);
    EXPECT_NEAR(limiter.used_acceleration_scale(), 0.5, 1e-9);
    limiter.step({}, kDt, false, 0.5);
    EXPECT_NEAR(limiter.used_acceleration_scale(), 1, 1e-9) << "decelerations are not scaled";
  }
}

// 1 m/s² grew under 10 m/s³: it fades as fast, and carries the speed on by 0.05 m/s, whatever the limit is now.
TEST(SpeedLimiter, AJerkLimitLoweredDuringARampHoldsUpNoStop) {
  for (const double jerk : {5.0, 2.0, 0.5, 0.1}) {
    SpeedLimiter limiter(kSmooth);
    while (limiter.value().linear < 0.2) limiter.step({1, 0}, kDt);
    SpeedLimits lower = kSmooth;
    lower.linear.jerk = jerk;
    limiter.set_limits(lower);
    double fastest = 0;
    for (int k = 0; k < 20'000; ++k) {
      const double before = limiter.value().linear;
      const double acceleration = limiter.acceleration().linear;
      const double now = limiter.step({0, 0}, kDt).linear;
      fastest = std::fmax(fastest, now);
      ASSERT_GE(now, 0) << jerk;
      ASSERT_GE((now - before) / kDt, acceleration - 10 * kDt - 1e-9) << jerk << ": fades at the old limit at most";
    }
    EXPECT_LE(fastest, 0.2 + 1e-3 + 0.05) << jerk;
    EXPECT_EQ(limiter.value().linear, 0) << jerk;
    while (limiter.value().linear < 0.2) {
      const double acceleration = limiter.acceleration().linear;
      limiter.step({1, 0}, kDt);
      ASSERT_LE(limiter.acceleration().linear, acceleration + jerk * kDt + 1e-9) << "the old limit is over";
    }
  }
}

TEST(SpeedLimiter, ALowerJerkHoldsBothWaysForARampThatBeginsAfterIt) {
  for (const bool turns : {false, true}) {
    const auto axis = [&](const PlanarTwist& twist) { return turns ? twist.angular : twist.linear; };
    const auto ask = [&](double speed) { return turns ? PlanarTwist{0, speed} : PlanarTwist{speed, 0}; };
    SpeedLimiter limiter(kSmooth);
    limiter.step(ask(1), kDt);
    SpeedLimits lower = kSmooth;
    lower.linear.jerk = lower.angular.jerk = 1;
    limiter.set_limits(lower);
    while (axis(limiter.value()) < 0.2) limiter.step(ask(1), kDt);
    for (double before = axis(limiter.acceleration()); before > 0.1; before = axis(limiter.acceleration())) {
      limiter.step(ask(0.3), kDt);
      ASSERT_GE(axis(limiter.acceleration()), before - 1 * kDt - 1e-9) << (turns ? "angular" : "linear");
    }
  }
}

TEST(SpeedLimiter, ATurnDoesNotHoldUpTheStopInAnEmergency) {
  SpeedLimits limits = kSmooth;
  limits.angular.deceleration = limits.angular.emergency_deceleration = 0.2;
  SpeedLimiter limiter(limits);
  cycles_to(limiter, {1, 1});
  int k = 0;
  while (limiter.value().linear != 0) {
    limiter.step({0, 0}, kDt, true);
    ++k;
  }
  EXPECT_NEAR(k, 1000 * (1 / 3.0 + 3.0 / 10), 1);
  EXPECT_GT(limiter.value().angular, 0.5);
}

// The wheels can give a hundredth of what speeds up on one axis, while the robot slows down on the other.
TEST(SpeedLimiter, SlowsDownOneAxisInTimeWhereTheTorqueForTheOtherIsMissing) {
  for (const auto& [from, to] : {std::pair{PlanarTwist{0.3, 0}, PlanarTwist{0, 2}}, {{0, 1}, {0.1, 0}}}) {
    const auto cycles = [&, to = to, turns = from.angular != 0](SpeedLimiter limiter, double torque) {
      int count = 0;
      for (PlanarTwist now{1, 1}; (turns ? now.angular : now.linear) != 0 && count < 100'000; ++count) {
        now = limiter.step(to, kDt, false, torque);
      }
      return count;
    };
    SpeedLimiter limiter(kSmooth);
    cycles_to(limiter, from);
    EXPECT_LE(cycles(limiter, 0.01), cycles(limiter, 1) + 1);
  }
}

// One axis slows down while the other one speeds up.
TEST(SpeedLimiter, MovesOnTheStraightLineBetweenTwoCommands) {
  for (const auto& [from, to] : {std::pair{PlanarTwist{0.8, 0}, PlanarTwist{0.2, 1}}, {{0.1, 1.5}, {0.9, 0.1}}}) {
    SpeedLimiter limiter(kSmooth);
    for (int k = 0; k < 3000; ++k) limiter.step(from, kDt);
    for (int k = 0; k < 3000; ++k) {
      const PlanarTwist now = limiter.step(to, kDt);
      ASSERT_NEAR((now.linear - from.linear) * (to.angular - from.angular),
                  (now.angular - from.angular) * (to.linear - from.linear), 1e-12);
    }
    EXPECT_EQ(limiter.value().linear, to.linear);
    EXPECT_EQ(limiter.value().angular, to.angular);
  }
}

/// There is no jerk limit. Forwards the limits are 1 m/s at 1 m/s² and 2 m/s², in reverse 0.2 m/s at 0.4 and 0.5 m/s².
SpeedLimits with_a_reverse_gear() {
  SpeedLimits limits;
  limits.linear = {.speed = 1, .acceleration = 1, .deceleration = 2, .emergency_deceleration = 4};
  limits.linear.reverse_speed = 0.2;
  limits.linear.reverse_acceleration = 0.4;
  limits.linear.reverse_deceleration = 0.5;
  return limits;
}

/// Largest change of speed, m/s², of the steps in which |v| grows and shrinks, between `start` and `target`.
struct Steepest {
  double grows = 0, shrinks = 0, end = 0;
};
Steepest drive_to(SpeedLimiter& limiter, double target) {
  Steepest steepest;
  for (int k = 0; k < 3000; ++k) {
    const double before = limiter.value().linear;
    const double after = limiter.step({target, 0}, 1e-3).linear;
    double& largest = std::abs(after) > std::abs(before) ? steepest.grows : steepest.shrinks;
    largest = std::max(largest, std::abs(after - before) / 1e-3);
    steepest.end = after;
  }
  return steepest;
}

TEST(SpeedLimiter, HasLimitsOfItsOwnInReverse) {
  SpeedLimiter limiter(with_a_reverse_gear());
  const Steepest forth = drive_to(limiter, 1);
  const Steepest back = drive_to(limiter, -1);
  const Steepest stop = drive_to(limiter, 0);
  EXPECT_EQ(forth.end, 1);
  EXPECT_NEAR(forth.grows, 1, 1e-9);
  EXPECT_EQ(back.end, -0.2);
  EXPECT_NEAR(back.shrinks, 2, 1e-9) << "forwards until it stands";
  EXPECT_NEAR(back.grows, 0.4, 1e-9);
  EXPECT_EQ(stop.end, 0);
  EXPECT_NEAR(stop.shrinks, 0.5, 1e-9);
}

}  // namespace robot_control::tests
