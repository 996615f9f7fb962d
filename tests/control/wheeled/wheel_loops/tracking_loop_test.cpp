#include "machine/encoders/tracking_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace robot_control::tests {

constexpr double kBandwidth = 20;
constexpr double kW = 2 * std::numbers::pi * kBandwidth;

/// A loop at rest at 0, on an encoder that has shown a step of 10⁻⁶ rad.
TrackingLoop of_exact_encoder(double dt) {
  TrackingLoop loop(kBandwidth, dt);
  loop.restart_from(0, 0);
  loop.step(1e-6, 0, 1);
  loop.restart_from(0, 0);
  return loop;
}

/// RMS of the velocity about `speed`, and its mean, in the last four of five seconds, with an encoder of `counts`.
struct Steady {
  double rms, mean;
};
Steady steady(double speed, double counts) {
  const double dt = 1e-3;
  const double count = 2 * std::numbers::pi / counts;
  TrackingLoop loop(kBandwidth, dt);
  loop.restart_from(0, speed);
  loop.step(count, 0, 1);  // it has turned by a count before
  loop.restart_from(0, speed);
  double square = 0;
  double sum = 0;
  for (int k = 1; k <= 5000; ++k) {
    loop.step(std::floor(speed * k * dt / count) * count, 0, 1);
    if (k <= 1000) continue;
    square += std::pow(loop.velocity() - speed, 2) / 4000;
    sum += (loop.velocity() - speed) / 4000;
  }
  return {std::sqrt(square), sum};
}

/// Tracks θ(t) = v·t + a·t²/2 + j·t³/6 for `seconds` from a cold start and returns the errors at the end.
struct Errors {
  double position, velocity, acceleration;
};
Errors track(double v, double a, double j, double dt, double seconds, double known = 0) {
  TrackingLoop loop = of_exact_encoder(dt);
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
  // After 1 s the triple pole has faded to (w·t)²/2·e^(−w·t) < 10⁻⁴⁹; the rest is rounding, amplified by 1/dt².
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
  TrackingLoop loop = of_exact_encoder(dt);
  double scaled[4] = {};
  for (int n = 1; n <= 12; ++n) {
    loop.step(1, 0, 1);
    for (int i = 0; i < 3; ++i) scaled[i] = scaled[i + 1];
    scaled[3] = (1 - loop.position()) * std::pow(p, -n);
    if (n >= 4) {
      const double third = scaled[3] - 3 * scaled[2] + 3 * scaled[1] - scaled[0];
      // The rounding of the position, 10⁻¹⁶, grows by p⁻ⁿ.
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

// At 20 Hz a linear law would have 0.04, 0.16 and 1.3 rad/s. `bound` is large if counts and period almost agree.
TEST(TrackingLoop, ShowsHardlyAnyCountsInSteadyMotion) {
  const struct { double counts, usual, bound; } encoders[] = {{4096, 0.006, 0.1}, {512, 0.03, 0.13}, {90, 0.05, 0.25}};
  for (const auto& encoder : encoders) {
    std::mt19937 random(static_cast<unsigned>(encoder.counts));
    std::vector<double> ripples;
    for (int i = 0; i < 41; ++i) {
      const double speed = std::uniform_real_distribution<double>(4, 10)(random);
      const Steady result = steady(speed, encoder.counts);
      ripples.push_back(result.rms);
      EXPECT_LT(std::abs(result.mean), 5e-3 * speed) << encoder.counts << " counts, " << speed << " rad/s";
    }
    std::ranges::sort(ripples);
    EXPECT_LT(ripples[20], encoder.usual) << encoder.counts;
    EXPECT_LT(ripples[40], encoder.bound) << encoder.counts;
  }
}

// A wheel stops at once, against its motor's torque. The speed must vanish after some time constants of the bandwidth,
// and one count that the wheel would still have to cross.
TEST(TrackingLoop, SeesAWheelStopWhateverItsCounts) {
  const double dt = 1e-3;
  const double speed = 8;
  for (const double counts : {4096, 512, 90}) {
    const double count = 2 * std::numbers::pi / counts;
    TrackingLoop loop(kBandwidth, dt);
    loop.restart_from(0, speed);
    for (int k = 1; k <= 2000; ++k) loop.step(std::floor(speed * k * dt / count) * count, 0, 1);
    const double stopped = loop.position();
    const double measured = std::floor(speed * 2 / count) * count;
    const int cycles = static_cast<int>((0.06 + count / speed) / dt);
    for (int k = 0; k < cycles; ++k) loop.step(measured, 0, 1);
    EXPECT_LT(loop.velocity(), 0.2 * speed) << counts;
    EXPECT_NEAR(loop.position(), stopped, 2 * count + 0.02 * speed) << counts;
  }
}

// The torque would accelerate a free wheel by 5 rad/s², and grows.
TEST(TrackingLoop, DoesNotTakeAWheelThatShowsNoCountsForATurningOne) {
  const double count = 2 * std::numbers::pi / 64;
  TrackingLoop loop(kBandwidth, 1e-3);
  loop.restart_from(0, 0.37);
  loop.step(count, 0, 1);
  loop.restart_from(0, 0.37);
  for (int k = 0; k < 1500; ++k) loop.step(0, 3e-3 * k, 1);
  EXPECT_LT(std::abs(loop.velocity()), 0.1);
}

// A light wheel stands in dry friction while its torque grows by 0.1 N·m/s. Without the silence of its counts the loop
// would show 1.5 rad/s.
TEST(TrackingLoop, DoesNotTakeTorqueThatGrowsAgainstFrictionForASpeed) {
  const double count = 2 * std::numbers::pi / 90;
  TrackingLoop loop(kBandwidth, 1e-3);
  loop.restart_from(0, 0);
  loop.step(count, 0, 1);
  loop.restart_from(0, 0);
  for (int k = 0; k < 1000; ++k) loop.step(0, 1.7 * k, 1);
  EXPECT_LT(std::abs(loop.velocity()), 0.5);
}

TEST(TrackingLoop, LearnsTheCountsOfItsEncoder) {
  TrackingLoop loop(kBandwidth, 1e-3);
  loop.restart_from(3, 0);
  loop.step(3, 0, 1);
  EXPECT_NEAR(loop.quantum(), 2 * std::numbers::pi / 45, 1e-15) << "the coarsest";
  loop.step(3.03, 0, 1);
  loop.step(3.04, 0, 1);
  EXPECT_NEAR(loop.quantum(), 0.01, 1e-12);
  loop.restart_from(0, 0);
  EXPECT_NEAR(loop.quantum(), 0.01, 1e-12);
  loop.step(0.00005, 0, 1);
  EXPECT_EQ(loop.quantum(), 0) << "exact";
}

TEST(TrackingLoop, TakesTheEncoderOfAnotherWheelAtAStand) {
  TrackingLoop turning(kBandwidth, 1e-3), standing(kBandwidth, 1e-3);
  standing.assume_encoder_of(turning);
  EXPECT_NEAR(standing.quantum(), 2 * std::numbers::pi / 45, 1e-15) << "none has shown a count";
  turning.step(0.01, 0, 1);
  standing.assume_encoder_of(turning);
  EXPECT_NEAR(standing.quantum(), 0.01, 1e-12);
  standing.step(0.03, 0, 1);
  standing.assume_encoder_of(turning);
  EXPECT_NEAR(standing.quantum(), 0.03, 1e-12) << "its own is another one";
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

}  // namespace robot_control::tests
