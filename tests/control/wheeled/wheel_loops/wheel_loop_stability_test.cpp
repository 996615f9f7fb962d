#include "control/wheeled/wheel_loops/wheel_loop_stability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "control/wheeled/wheel_loops/wheel_loop.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr double kTrackingBandwidth = 20;
constexpr double kLifted = 0.005;
constexpr double kTurning = 0.045;
constexpr double kStraight = 0.065;
constexpr double kDoubled = 0.125;  // 24 kg

double radius(const WheelLoopGains& gains, double inertia, double period = kPeriod) {
  return wheel_loop_spectral_radius(gains, {inertia}, period, kTrackingBandwidth);
}

/// Runs the classes themselves on one wheel, disturbed at the start. Returns the growth per cycle of the envelope
/// between the middle and the end of `cycles`.
double simulated_growth(const WheelLoopGains& gains, const WheelLoad& load, int cycles, std::size_t delay = 0) {
  constexpr int kParts = 100;  // parts of a cycle, for the damping
  WheelLoop loop(gains, kTrackingBandwidth, std::numeric_limits<double>::max(), kPeriod);
  double angle = 0;
  double speed = 1e-3;
  double applied = 0;
  std::deque<double> pending(delay + 1, 0);
  double middle = 0;
  double end = 0;
  loop.measure({}, 1, true);
  for (int k = 1; k <= cycles; ++k) {
    for (int part = 0; part < kParts; ++part) {
      const double step = kPeriod / kParts;
      const double acceleration = (applied - load.damping * speed) / load.inertia;
      angle += speed * step + 0.5 * acceleration * step * step;
      speed += acceleration * step;
    }
    loop.measure({.position = angle, .effort = applied}, 1, true);
    pending.push_back(loop.step({}, 1));
    applied = pending.front();
    pending.pop_front();
    const int window = cycles / 4;
    if (k <= cycles / 2 && k > cycles / 2 - window) middle = std::fmax(middle, std::abs(speed));
    if (k > cycles - window) end = std::fmax(end, std::abs(speed));
  }
  return std::pow(end / middle, 2.0 / cycles);
}

TEST(WheelLoopSpectralRadius, IsBelowOneForTheDefaultGainsWhateverTheWheelDrives) {
  for (const double inertia : {kLifted, 0.01, 0.02, kTurning, kStraight, kDoubled, 0.5}) {
    EXPECT_LT(radius({}, inertia), 1) << inertia;
  }
}

TEST(WheelLoopSpectralRadius, IsTheOneInTheHeader) {
  EXPECT_NEAR(radius({}, kLifted), 0.990, 5e-4);
  EXPECT_NEAR(radius({}, kTurning), 0.987, 5e-4);
  EXPECT_NEAR(radius({}, kStraight), 0.990, 5e-4);
  EXPECT_NEAR(radius({}, kDoubled), 0.995, 5e-4);
}

TEST(WheelLoopSpectralRadius, StaysBelowOneWithAllGainsTimes4_8) {
  for (const double inertia : {kLifted, kTurning, kStraight, kDoubled}) {
    EXPECT_LT(radius({4.8 * 2, 4.8 * 20, 0, 0.01}, inertia), 1) << inertia;
    EXPECT_GT(radius({5.2 * 2, 5.2 * 20, 0, 0.01}, inertia), 1) << inertia;
  }
}

TEST(WheelLoopSpectralRadius, IsFarAboveOneForTheArticlesGains) {
  for (const double inertia : {kLifted, kTurning, kStraight, kDoubled}) {
    EXPECT_GT(radius({20, 0.1, 0.5, 0.01}, inertia), 7) << inertia;
    EXPECT_GT(radius({20, 0.1, 0.5, std::numeric_limits<double>::infinity()}, inertia), 1) << inertia;
  }
}

TEST(WheelLoopSpectralRadius, IsAboveOneForALiftedWheelWhoseTrackingLoopIsNotToldTheTorque) {
  const double untold = std::numeric_limits<double>::infinity();
  EXPECT_GT(radius({2, 20, 0, untold}, kLifted), 1);
  EXPECT_GT(radius({0.89, 0, 0, untold}, kLifted), 1);
  EXPECT_LT(radius({0.87, 0, 0, untold}, kLifted), 1);
}

// A rule of thumb: with kd = 0 and a tracking loop that is slow against the period, any load is unstable above
// kp·period/model_inertia = 1.
TEST(WheelLoopSpectralRadius, IsAboveOneOnceTheGainTimesThePeriodExceedsTheInertia) {
  for (const double period : {5e-4, 1e-3, 2e-3}) {
    const WheelLoopGains gains{1.02 * 0.01 / period, 0, 0, 0.01};
    for (const double inertia : {kLifted, kTurning, kStraight, kDoubled}) {
      EXPECT_GT(radius(gains, inertia, period), 1) << period << " " << inertia;
    }
  }
}

TEST(WheelLoopSpectralRadius, IsTheGrowthOfTheRealClasses) {
  // A real eigenvalue dominates (the slow integrator), or a pair that grows: the envelope shows it to 0.1 %.
  EXPECT_NEAR(simulated_growth({}, {kStraight}, 1600), radius({}, kStraight), 1e-3);
  EXPECT_NEAR(simulated_growth({}, {kLifted}, 1600), radius({}, kLifted), 1e-3);
  EXPECT_NEAR(simulated_growth({12, 20, 0, 0.01}, {kStraight}, 400), radius({12, 20, 0, 0.01}, kStraight), 5e-3);
  EXPECT_NEAR(simulated_growth({20, 0.1, 0.5, 0.01}, {kLifted}, 60), radius({20, 0.1, 0.5, 0.01}, kLifted), 0.05);
}

TEST(WheelLoopSpectralRadius, IsTheGrowthOfTheRealClassesInADampedJointToo) {
  for (const double damping : {0.1, 1.0, 3.0}) {
    const WheelLoad load{kLifted, damping};
    EXPECT_NEAR(simulated_growth({}, load, 1600), wheel_loop_spectral_radius({}, load, kPeriod, kTrackingBandwidth),
                1e-3)
        << damping;
  }
}

TEST(WheelLoopSpectralRadius, IsTheGrowthOfTheRealClassesBehindALateActuatorToo) {
  for (const unsigned delay : {1u, 2u}) {
    const double predicted = wheel_loop_spectral_radius({}, {kStraight}, kPeriod, kTrackingBandwidth, delay);
    EXPECT_NEAR(simulated_growth({}, {kStraight}, 1600, delay), predicted, 1e-3) << delay;
  }
  // A lifted wheel oscillates ever more: a pair dominates, and the envelope shows it to 0.5 %.
  const double predicted = wheel_loop_spectral_radius({}, {kLifted}, kPeriod, kTrackingBandwidth, 8);
  EXPECT_GT(predicted, 1);
  EXPECT_NEAR(simulated_growth({}, {kLifted}, 400, 8), predicted, 5e-3);
}

TEST(WheelLoopSpectralRadius, GrowsWithEveryCycleOfDelayWhereTheWheelIsLifted) {
  for (unsigned delay = 4; delay < 12; ++delay) {
    EXPECT_LT(wheel_loop_spectral_radius({}, {kLifted}, kPeriod, kTrackingBandwidth, delay),
              wheel_loop_spectral_radius({}, {kLifted}, kPeriod, kTrackingBandwidth, delay + 1))
        << delay;
  }
}

}  // namespace robot_control::tests
