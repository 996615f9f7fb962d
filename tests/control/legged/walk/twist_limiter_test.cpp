#include "control/legged/walk/twist_limiter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/legged/walk/gait_table.h"
#include "signals/command_frame.h"
#include "signals/legged/legged_command.h"

namespace robot_control::tests {

constexpr double kPeriod = 0.001;  // s
const LegControllerParameters kParameters{.max_linear_speed = 1.2,
                                          .max_lateral_speed = 0.4,
                                          .max_angular_speed = 2,
                                          .max_linear_acceleration = 2,
                                          .max_lateral_acceleration = 1.5,
                                          .max_angular_acceleration = 4};
constexpr WalkingTwist kAnything{100, 100, 100};  // m/s, rad/s, of legs that are fast enough

struct TwistLimiterTest : testing::Test {
  /// Steps once, and keeps the largest acceleration of each axis.
  void step(const WalkingTwist& target, bool emergency = false) {
    const WalkingTwist before = twist;
    reasons = 0;
    twist = limiter.step(state, target, capable, emergency, kPeriod, reasons);
    for (std::size_t i = 0; i < twist.size(); ++i)
      fastest[i] = std::max(fastest[i], std::abs(twist[i] - before[i]) / kPeriod);
    ++steps;
  }
  /// Steps until this twist; returns all reasons of the way.
  std::uint64_t reach(const WalkingTwist& target, bool emergency = false) {
    std::uint64_t all = 0;
    fastest = {};
    steps = 0;
    while (twist != target && steps < 10000) {
      step(target, emergency);
      all |= reasons;
    }
    return all;
  }

  std::array<MotionLimits, 3> limits = twist_limits(kParameters);
  TwistLimiter limiter{limits};
  TwistLimiter::State state;
  WalkingTwist capable = kAnything, twist{}, fastest{};
  std::uint64_t reasons = 0;
  int steps = 0;
};

TEST_F(TwistLimiterTest, EachAxisHasItsOwnParameters) {
  EXPECT_EQ(limits[0].speed, 1.2);
  EXPECT_EQ(limits[1].speed, 0.4);
  EXPECT_EQ(limits[2].speed, 2);
  const std::array<double, 3> accelerations{2, 1.5, 4};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    EXPECT_EQ(limits[i].acceleration, accelerations[i]) << i;
    EXPECT_EQ(limits[i].deceleration, accelerations[i]) << i;
    EXPECT_GT(limits[i].emergency_deceleration, accelerations[i]) << i;
  }
}

TEST_F(TwistLimiterTest, ScalesATargetBeyondAnAxisWithoutTurningIt) {
  for (const double sense : {1.0, -1.0}) {
    const WalkingTwist within{0.6 * sense, -0.4, 0.2 * sense};
    reach(within);
    EXPECT_EQ(reasons & kReasonSpeedLimited, 0u) << "a speed may be as large as its limit";
    for (int i = 0; i < 100; ++i) step({2 * within[0], 2 * within[1], 2 * within[2]});
    for (std::size_t i = 0; i < twist.size(); ++i) EXPECT_NEAR(twist[i], within[i], 1e-9) << i;
    EXPECT_EQ(reasons, std::uint64_t{kReasonSpeedLimited});
  }
}

TEST_F(TwistLimiterTest, ScalesATargetUntilThePartsOfWhatTheLegsCanDoAreOneTogether) {
  capable = {1, 0.5, 4};
  const WalkingTwist whole{0.5, -0.125, 1};  // ½ + ¼ + ¼
  reach(whole);
  step(whole);
  EXPECT_EQ(reasons, 0u);
  for (int i = 0; i < 100; ++i) step({1.0, -0.25, 2});
  for (std::size_t i = 0; i < twist.size(); ++i) EXPECT_NEAR(twist[i], whole[i], 1e-9) << i;
  EXPECT_EQ(reasons, std::uint64_t{kReasonLegSpeed});
}

TEST_F(TwistLimiterTest, TheTighterOfBothScalesIsInForce) {
  capable = {1, 0.5, 4};
  for (int i = 0; i < 3000; ++i) step({2.4, 0, 0});  // twice its limit
  EXPECT_NEAR(twist[0], 1, 1e-9);
  EXPECT_EQ(reasons, std::uint64_t{kReasonSpeedLimited} | kReasonLegSpeed);
  capable = {10, 10, 10};
  for (int i = 0; i < 3000; ++i) step({2.4, 0, 0});
  EXPECT_NEAR(twist[0], 1.2, 1e-9);
  EXPECT_EQ(reasons, std::uint64_t{kReasonSpeedLimited});
}

TEST_F(TwistLimiterTest, AllAxesArriveTogetherAndTheSlowestIsAtItsLimit) {
  const WalkingTwist target{0.6, -0.4, 0.3};
  while (twist != target && steps < 10000) {
    step(target);
    EXPECT_NEAR(twist[1] / target[1], twist[0] / target[0], 1e-9) << steps;
    EXPECT_NEAR(twist[2] / target[2], twist[0] / target[0], 1e-9) << steps;
  }
  // The ways need 0.3, 0.27 and 0.075 s at the limits of their axes: the linear one sets the time.
  EXPECT_NEAR(fastest[0], 2, 1e-9);
  EXPECT_NEAR(fastest[1], 2 * 0.4 / 0.6, 1e-9);
  EXPECT_NEAR(fastest[2], 2 * 0.3 / 0.6, 1e-9);
}

TEST_F(TwistLimiterTest, BrakesTogetherToo) {
  reach({0.4, 0.4, 0.4});
  reach({});
  EXPECT_NEAR(fastest[0], 1.5, 1e-9);
  EXPECT_NEAR(fastest[1], 1.5, 1e-9);
  EXPECT_NEAR(fastest[2], 1.5, 1e-9);
}

TEST_F(TwistLimiterTest, AnEmergencyStopsEachAxisAsFastAsItsOwnLimitsAllow) {
  const WalkingTwist moving{1, 0.4, 1};
  reach(moving);
  std::array<double, 3> stopped{};
  fastest = {};
  for (int i = 1; i < 2000; ++i) {
    step({}, true);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (twist[axis] != 0) stopped[axis] = i * kPeriod;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double deceleration = limits[axis].emergency_deceleration, jerk = limits[axis].jerk;
    const bool reached = moving[axis] > deceleration * deceleration / jerk;
    EXPECT_NEAR(stopped[axis],
                reached ? moving[axis] / deceleration + deceleration / jerk : 2 * std::sqrt(moving[axis] / jerk),
                0.05 * stopped[axis])
        << axis;
    if (reached) {
      EXPECT_NEAR(fastest[axis], deceleration, 1e-9) << axis;
    }
  }
}

TEST_F(TwistLimiterTest, NamesTheLimitsThatSlowItDown) {
  step({1, 0, 0});
  EXPECT_EQ(reasons, std::uint64_t{kReasonJerkLimited});
  while (std::abs(state.axes[0].acceleration) < 2 && steps < 1000) step({1, 0, 0});
  step({1, 0, 0});
  EXPECT_EQ(reasons, std::uint64_t{kReasonAccelerationLimited});
  step({}, false);
  EXPECT_EQ(reasons & kReasonJerkYielded, 0u);
  TwistLimiter::State slow;
  slow.axes[0] = {.speed = 1e-4, .acceleration = -1};
  std::uint64_t yielded = 0;
  limiter.step(slow, {}, kAnything, false, kPeriod, yielded);
  EXPECT_NE(yielded & kReasonJerkYielded, 0u);
}

/// The body goes on for half a period before the ramp begins.
TEST_F(TwistLimiterTest, TheStopDistanceIsThatOfTheRampAndOfHalfAPeriod) {
  for (const bool emergency : {false, true}) {
    for (const double speed : {0.05, 1.0}) {
      state = {};
      twist = {};
      reach({speed, 0, 0});
      double distance = 0;
      while (twist[0] != 0) {
        step({}, emergency);
        distance += twist[0] * kPeriod;
      }
      const double half = std::sqrt(0.852 / 0.426) * kGaits[gait_named("trot")].period / 2;
      for (const double sense : {1.0, -1.0})
        EXPECT_NEAR(walking_stop_distance(kParameters, 0.852, sense * speed, emergency), distance + speed * half,
                    speed * 2 * kPeriod);
    }
  }
}

}  // namespace robot_control::tests
