#include "control/wheeled/wheel_loops/wheel_loop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/constants.h"

namespace robot_control::tests {

constexpr double kLimit = 5;

/// A loop whose encoder has shown a step of 10⁻⁶ rad, so that it is taken for exact.
WheelLoop seeded(double velocity = 0, const WheelLoopGains& gains = {}) {
  WheelLoop loop(gains, 20, kLimit, kPeriod);
  loop.measure({}, 1, false);
  loop.measure({.position = 1e-6}, 1, false);
  loop.restart_tracking();
  loop.measure({.velocity = velocity}, 1, true);
  return loop;
}

TEST(WheelLoop, TakesTheSpeedOfItsFirstSampleWithoutATransient) {
  WheelLoop loop = seeded(3);
  EXPECT_EQ(loop.velocity(), 3);
  loop.measure({.position = 3 * kPeriod, .velocity = 3}, 1, true);
  EXPECT_NEAR(loop.velocity(), 3, 1e-14);
}

TEST(WheelLoop, PassesFeedForwardThroughWhenThereIsNoError) {
  WheelLoop loop = seeded();
  EXPECT_EQ(loop.step({.feed_forward = 0.65}, 1), 0.65);
}

TEST(WheelLoop, GivesTheCarriedEffortFirst) {
  WheelLoop loop = seeded(0, {.kd = 0.02});
  // A moving wheel accelerates: kd must show neither.
  for (int k = 1; k <= 50; ++k) {
    const double t = k * kPeriod;
    loop.measure({.position = 5 * t * t, .effort = 1.3}, 1, false);
    loop.reset_to_measured();
  }
  loop.preload_integrator(1.3);
  EXPECT_NEAR(loop.step({.velocity = loop.velocity()}, 1), 1.3, 1e-14);
}

TEST(WheelLoop, TakesNoBrakeTorqueForAnAcceleration) {
  WheelLoop loop = seeded();
  for (int k = 0; k < 100; ++k) {
    loop.measure({.effort = k < 50 ? 1.3 : -2}, 1, false);
    loop.reset_to_measured();
    ASSERT_EQ(loop.velocity(), 0);
  }
}

TEST(WheelLoop, TakesTheLoadAtTheHandOverForNoAcceleration) {
  WheelLoop loop = seeded();
  loop.preload_integrator(1.3);
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(loop.step({}, 1), 1.3);
    loop.measure({.effort = 1.3}, 1, true);
    ASSERT_EQ(loop.velocity(), 0);
  }
}

// A slope began on the way. If the residual kept it, the loop would report 2 rad/s of a wheel that the brake holds.
TEST(WheelLoop, TakesALoadThatTheBrakeTakesOverForNoAcceleration) {
  WheelLoop loop = seeded();
  double effort = 0;
  for (int k = 0; k < 1000; ++k) {
    loop.measure({.position = 1e-6, .effort = effort}, 1, true);
    effort = loop.step({.velocity = 0.05}, 1);
  }
  ASSERT_GT(effort, 0.5);
  for (int k = 0; k < 100; ++k) {
    loop.measure({.position = 1e-6, .effort = -effort}, 1, false);
    ASSERT_LT(std::abs(loop.velocity()), 0.05);
  }
}

TEST(WheelLoop, ComparesWithThePlanOfTwoCyclesAgo) {
  WheelLoop loop = seeded(0, {.kp = 2, .ki = 0});
  EXPECT_EQ(loop.step({.velocity = 1}, 1), 0);
  loop.measure({}, 1, true);
  EXPECT_EQ(loop.step({.velocity = 1}, 1), 0);
  loop.measure({}, 1, true);
  EXPECT_NEAR(loop.step({.velocity = 1}, 1), 2, 1e-15);
}

TEST(WheelLoop, NeverExceedsTheEffortLimitAndSaysThatItIsThere) {
  WheelLoop loop = seeded();
  for (int k = 0; k < 10; ++k) {
    loop.measure({}, 1, true);
    EXPECT_LE(std::abs(loop.step({.velocity = 1000}, 1)), kLimit);
  }
  EXPECT_TRUE(loop.saturated());
}

/// N·m that the integral gains in 0.1 s. The wheel stands 1 rad/s below its plan, and the gate clamps the torque to
/// `part` of it.
double gained_while_clamped(double part) {
  WheelLoop loop = seeded(0, {.model_inertia = 1e9});
  double acting = 0;
  const auto cycle = [&](bool clamped) {
    const double next = loop.step({.velocity = 1}, 1, clamped);
    loop.measure({.position = 1e-6, .effort = part * acting}, 1, true);
    acting = next;
  };
  for (int k = 0; k < 4; ++k) cycle(false);  // until the first torque has acted
  const double before = loop.integral();
  for (int k = 0; k < 100; ++k) cycle(true);
  return loop.integral() - before;
}

TEST(WheelLoop, DoesNotWindUpWhileTheGateTakesItsTorque) {
  for (const double part : {0.0, 0.5, 0.9}) EXPECT_EQ(gained_while_clamped(part), 0) << part;
}

TEST(WheelLoop, IntegratesWhileTheGateTakesTheTorqueOfAnotherWheel) {
  // The gain is ki·error·time; the tracked speed still shows the step of the seed.
  EXPECT_NEAR(gained_while_clamped(1), 20 * 1 * 0.1, 1e-4);
}

TEST(WheelLoop, UnwindsWhileTheGateClamps) {
  WheelLoop loop = seeded(0);
  loop.preload_integrator(1);
  for (int k = 0; k < 3; ++k) loop.step({.velocity = -0.4}, 1, true);  // 1 − 0.8 N·m: still upwards
  EXPECT_LT(loop.integral(), 1);
}

/// A wheel in a joint of strong damping has a loop that is weak beside it, as derived gains at 500 Hz may be. Its
/// integrator unwinds with ki/(kp + damping), 0.24 1/s.
struct DampedWheel {
  static constexpr double kStep = 0.002, kInertia = 2e-4, kDamping = 0.2;  // s, kg·m², N·m·s/rad
  WheelLoop loop{{.kp = 0.005, .ki = 0.05, .model_inertia = 0.0032}, 20, 0.28, kStep};
  double angle = 0, speed = 0;
  double acting = 0, next = 0;  ///< N·m of this cycle, and the command for the next one

  /// The gate passes `part` of the torque in one cycle of every `every`.
  void run(double seconds, double velocity, double part, int every) {
    for (int k = 0; k < std::lround(seconds / kStep); ++k) {
      loop.measure({.position = angle, .velocity = speed, .effort = acting}, 1, true);
      const double ordered = loop.step({.velocity = velocity, .feed_forward = kDamping * velocity}, 1, clamped_);
      clamped_ = part < 1 && k % every == 0;
      acting = (clamped_ ? part : 1) * next;
      next = ordered;
      const double before = speed;
      speed = (speed + kStep * acting / kInertia) / (1 + kStep * kDamping / kInertia);
      angle += 0.5 * kStep * (before + speed);
    }
  }

 private:
  bool clamped_ = false;
};

// The gate's taper acts in some cycles alone, when the measured speed is near the limit. The wheel lags all the time.
TEST(WheelLoop, LeavesNothingToUnwindWhereTheGateTookTorqueNowAndThen) {
  for (const int every : {1, 2, 5}) {
    DampedWheel wheel;
    wheel.run(10, 0.9, 0.2, every);
    EXPECT_LT(std::abs(wheel.loop.integral()), 0.02 * DampedWheel::kDamping) << every;
    wheel.run(0.25, 0, 1, 1);
    EXPECT_LT(std::abs(wheel.speed), 0.02) << "rad/s, standstill; one cycle of " << every;
  }
}

TEST(WheelLoop, DoesNotWindUpWhileItIsBlocked) {
  WheelLoop loop = seeded();
  const auto push = [&](int cycles) {
    for (int k = 0; k < cycles; ++k) {
      loop.measure({.effort = kLimit}, 1, true);
      loop.step({.velocity = 10}, 1);  // kp·10 = 20 N·m, four times the limit
    }
  };
  push(100);  // until the tracking loop has learned that torque does not move this wheel
  const double before = loop.integral();
  push(10000);
  EXPECT_EQ(loop.integral(), before);
  EXPECT_LT(std::abs(before), 0.1);
}

TEST(WheelLoop, HoldsAnIntegralWithinTheEffortLimit) {
  WheelLoop loop = seeded(0, {.kp = 0, .ki = 100});
  for (int k = 0; k < 10000; ++k) {
    loop.measure({}, 1, true);
    loop.step({.velocity = 10}, 1);
    ASSERT_LE(loop.integral(), kLimit);
  }
  // It also leaves the limit at once when the error turns.
  loop.reset_to_measured();
  loop.step({.velocity = -10}, 1);
  loop.step({.velocity = -10}, 1);
  loop.step({.velocity = -10}, 1);
  EXPECT_LT(loop.integral(), kLimit);
}

TEST(WheelLoop, ForgetsWhatItCarriedWithoutAnIntegrator) {
  WheelLoop loop = seeded(0, {.ki = 0});
  loop.preload_integrator(1.3);
  EXPECT_NEAR(loop.step({}, 1), 1.3, 0.02) << "no jump";
  double angle = 0;
  for (int k = 0; k < 1000; ++k) {
    loop.measure({.position = angle}, 1, true);
    loop.step({}, 1);
  }
  EXPECT_LT(loop.integral(), 1.3 * std::exp(-9.9)) << "a tenth of a second, ten times";
}

}  // namespace robot_control::tests
