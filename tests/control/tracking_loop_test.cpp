#include "control/wheel_loops/tracking_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace robot_control {
namespace {

constexpr double kBandwidth = 20;
constexpr double kW = 2 * std::numbers::pi * kBandwidth;

/// Tracks θ(t) = v·t + a·t²/2 + j·t³/6 for `seconds` from a cold start and returns the errors at the end.
struct Errors {
  double position, velocity, acceleration;
};
Errors track(double v, double a, double j, double dt, double seconds, double known = 0) {
  TrackingLoop loop(kBandwidth, dt);
  loop.restart_from(0, 0);
  double t = 0;
  const int cycles = static_cast<int>(seconds / dt + 0.5);
  for (int k = 1; k <= cycles; ++k) {
    t = k * dt;
    loop.step(v * t + a * t * t / 2 + j * t * t * t / 6, known, 1);
  }
  return {v * t + a * t * t / 2 + j * t * t * t / 6 - loop.position(), v + a * t + j * t * t / 2 - loop.velocity(),
          a + j * t - loop.acceleration()};
}

class TrackingLoopRates : public testing::TestWithParam<double> {};

TEST_P(TrackingLoopRates, HasNoErrorLeftForConstantAcceleration) {
  // After 1 s the triple pole has faded to (w·t)²/2·e^(−w·t) < 10⁻⁴⁹; what is left is rounding, amplified by 1/dt².
  const Errors errors = track(5, 10, 0, 1 / GetParam(), 1);
  EXPECT_NEAR(errors.position, 0, 1e-12);
  EXPECT_NEAR(errors.velocity, 0, 1e-10);
  EXPECT_NEAR(errors.acceleration, 0, 1e-7);
}

TEST_P(TrackingLoopRates, HasNoErrorLeftWhenTheKnownAccelerationIsWrong) {
  const Errors errors = track(5, 10, 0, 1 / GetParam(), 1, -70);
  EXPECT_NEAR(errors.velocity, 0, 1e-10);
  EXPECT_NEAR(errors.acceleration, 0, 1e-7);
}

TEST_P(TrackingLoopRates, FadesWithTheTriplePoleItPromises) {
  // Error after a step of one in the angle: (c0 + c1·n + c2·n²)·pⁿ, so e·p⁻ⁿ has a vanishing third difference.
  const double dt = 1 / GetParam();
  const double p = std::exp(-kW * dt);
  TrackingLoop loop(kBandwidth, dt);
  loop.restart_from(0, 0);
  double scaled[4] = {};
  for (int n = 1; n <= 12; ++n) {
    loop.step(1, 0, 1);
    for (int i = 0; i < 3; ++i) scaled[i] = scaled[i + 1];
    scaled[3] = (1 - loop.position()) * std::pow(p, -n);
    if (n >= 4) {
      const double third = scaled[3] - 3 * scaled[2] + 3 * scaled[1] - scaled[0];
      // Rounding of the position, 10⁻¹⁶, is blown up by p⁻ⁿ.
      EXPECT_NEAR(third, 0, 1e-14 * std::pow(p, -n)) << "n " << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(From100To2000Hz, TrackingLoopRates, testing::Values(100.0, 500.0, 1000.0, 2000.0));

TEST(TrackingLoop, LagsAConstantJerkByTheErrorInItsHeader) {
  const double jerk = 1000;
  const double dt = 1e-4;  // w·dt = 0.013: the continuous formulas hold to a few per cent
  const Errors errors = track(0, 0, jerk, dt, 1);
  EXPECT_NEAR(errors.position, jerk / (kW * kW * kW), 0.03 * jerk / (kW * kW * kW));
  EXPECT_NEAR(errors.velocity, 3 * jerk / (kW * kW), 0.03 * 3 * jerk / (kW * kW));
}

TEST(TrackingLoop, MovesTheSpeedOfOneEncoderCountByNoMoreThanItsGain) {
  const double dt = 1e-3;
  const double count = 2 * std::numbers::pi / 4096;
  const double p = std::exp(-kW * dt);
  const double jump = 1.5 * (1 - p) * (1 - p) * (1 + p) / dt * count;
  EXPECT_NEAR(jump, 0.060, 0.0005);  // the header's figure
  TrackingLoop loop(kBandwidth, dt);
  loop.restart_from(0, 0);
  loop.step(count, 0, 1);
  EXPECT_NEAR(loop.velocity(), jump, 1e-15);
}

TEST(TrackingLoop, StaysWithinATwentiethOfTheQuantumOfDifferencing) {
  const double dt = 1e-3;
  const double count = 2 * std::numbers::pi / 4096;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const double speed = std::uniform_real_distribution<double>(2, 10)(random);
    TrackingLoop loop(kBandwidth, dt);
    loop.restart_from(0, speed);
    double tracked = 0;
    for (int k = 1; k <= 5000; ++k) {
      const double angle = std::floor(speed * k * dt / count) * count;
      loop.step(angle, 0, 1);
      if (k > 1000) {
        tracked += std::pow(loop.velocity() - speed, 2);
      }
    }
    EXPECT_LT(std::sqrt(tracked / 4000), count / dt / 20) << "seed " << seed << ", speed " << speed;
  }
}

TEST(TrackingLoop, PredictsOverSkippedSamples) {
  const double dt = 1e-3;
  TrackingLoop loop(kBandwidth, dt);
  loop.restart_from(0, 5);
  double t = 0;
  for (const int periods : {1, 3, 1, 7, 2}) {
    t += periods * dt;
    loop.step(5 * t, 0, periods);
    EXPECT_NEAR(loop.velocity(), 5, 1e-12);
  }
}

}  // namespace
}  // namespace robot_control
