// The slip watch names wheels that spin or are stuck, and a robot that is blocked. Rolling wheels raise no slip.

#include "estimation/wheeled/slip/slip_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "signals/state_frame.h"

namespace robot_control::tests {

/// A body on wheels that drives ahead; its data come at 200 Hz.
struct SlipWatchTest : testing::Test {
  static constexpr double kStep = 0.005;  ///< s

  SlipWatchTest() { watch_.restart_at_rest(0); }
  /// Drives with these accelerations of the body and of the treads, m/s². Returns the s with slip.
  double drive(double seconds, double body = 0, double treads = 0) {
    double slips = 0;
    for (double t = 0; t < seconds - kStep / 2; t += kStep) {
      way_ += (speed_ + body * kStep / 2) * kStep;
      rolled_ += (tread_ + treads * kStep / 2) * kStep;
      const double travel = (tread_ + treads * kStep / 2) * kStep;
      speed_ += body * kStep;
      tread_ += treads * kStep;
      const SlipWatch::Sample sample{.dt = kStep,
                                     .acceleration = {body + error_ + noise_ / std::sqrt(kStep) * normal_(random_), 0},
                                     .travel = travel,
                                     .speed = tread_,
                                     .both_sides_read = true};
      if (watch_.step(sample)) {
        variance_ += watch_.evaluate({.gravity_variance = 1e-6, .clock_offset = offset_}, rested_);
      }
      slips += watch_.slips() ? kStep : 0;
    }
    return slips;
  }
  void learn() {
    drive(0.5, 1, 1);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(drive(1, 0.4, 0.4) + drive(1, -0.4, -0.4), 0) << i;
  }
  /// A wall stops the body within 50 ms while the wheels turn on.
  void hit() { drive(0.05, -speed_ / 0.05, 0); }
  bool named(std::uint64_t reason) const { return (watch_.reasons() & reason) != 0; }

  SlipWatch watch_{SlipParams{}};
  double noise_ = SlipParams{}.accelerometer;  ///< m/s²/√Hz
  double error_ = 0;                           ///< m/s², of the accelerometer
  double offset_ = 0;                          ///< s
  bool rested_ = true;
  double speed_ = 0, tread_ = 0, way_ = 0, rolled_ = 0, variance_ = 0;
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_{0, 1};
};

TEST_F(SlipWatchTest, RollingIsNoSlip) {
  learn();
  EXPECT_GE(watch_.level(), 1);
  EXPECT_EQ(variance_, 0);
}

TEST_F(SlipWatchTest, ASpinIsNamedWithinItsSpanAndWidens) {
  learn();
  drive(0.1, 0, 5);
  EXPECT_GT(drive(1), 1 - Tuning::kSlipSpan);
  EXPECT_TRUE(named(kSlipSpinning));
  EXPECT_FALSE(named(kSlipBlocked));
  EXPECT_LT(rolled_ - way_, 3 * std::sqrt(variance_));
  EXPECT_GT(watch_.speed_deviation(), 0.5 * 0.5 / std::sqrt(3));
}

TEST_F(SlipWatchTest, WheelsThatAreStuckAreNamed) {
  learn();
  drive(0.1, 0, -tread_ / 0.1);
  EXPECT_GT(drive(1), 1 - Tuning::kSlipSpan);
  EXPECT_TRUE(named(kSlipStalled));
}

TEST_F(SlipWatchTest, ASpinEndsWhereTheWheelsGripAgain) {
  learn();
  drive(0.1, 0, 5);
  drive(1);
  drive(0.1, 0, -5);
  EXPECT_LT(drive(3), 2 * Tuning::kSlipSpan);
  EXPECT_FALSE(watch_.slips());
  EXPECT_EQ(watch_.reasons(), 0u);
}

// An accelerometer that errs by 0.03 m/s² does not end it.
TEST_F(SlipWatchTest, ARobotThatAWallBlocksIsNamedSoAfterASecondAndStaysSo) {
  learn();
  error_ = 0.03;
  hit();
  drive(Tuning::kBlock + Tuning::kSlipSpan);
  EXPECT_TRUE(named(kSlipBlocked));
  EXPECT_GT(drive(4), 3.9);
  EXPECT_TRUE(named(kSlipBlocked));
  EXPECT_LT(rolled_ - way_, 3 * std::sqrt(variance_));
}

// Its wheels begin to turn, and it stays where it rested.
TEST_F(SlipWatchTest, ARobotThatIsBlockedFromTheStartIsNamed) {
  learn();
  speed_ = tread_ = 0;
  watch_.restart_at_rest(0);
  drive(0.5, 0, 1);
  drive(Tuning::kBlock + Tuning::kSlipSpan);
  EXPECT_TRUE(named(kSlipBlocked));
}

// The accelerometer's bias is not known.
TEST_F(SlipWatchTest, NothingIsNamedBeforeTheFirstRest) {
  learn();
  rested_ = false;
  hit();
  EXPECT_EQ(drive(3), 0);
}

// Wheels that are late by τ leave the body behind by τ Δv. Promised: slip for at most 3 % of the minute.
TEST_F(SlipWatchTest, AnUnknownClockOffsetIsNoSlip) {
  learn();
  offset_ = 0.1;
  double slips = 0;
  for (int i = 0; i < 20; ++i) {
    slips += drive(0.1, 1, 0) + drive(0.3, 1, 1) + drive(0.1, 0, 1) + drive(1);
    slips += drive(0.1, -1, 0) + drive(0.3, -1, -1) + drive(0.1, 0, -1) + drive(1);
  }
  EXPECT_LT(slips, 0.03 * 20 * 3);
}

// The level of a floor that shakes follows the residuals, and an hour of it is no slip.
TEST_F(SlipWatchTest, AShakingFloorIsNoSlip) {
  noise_ *= 30;
  learn();
  EXPECT_LT(drive(3600), 36);
  EXPECT_GT(watch_.level(), 3);
}

TEST_F(SlipWatchTest, TheAccelerometersSlowErrorIsTheGravityError) {
  learn();
  error_ = 0.03;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 4000; ++i) {
    drive(kStep);
    if (watch_.gravity_error().interval == 0 || i % 10 != 0) continue;
    sum += watch_.gravity_error().along;
    ++count;
  }
  ASSERT_GT(count, 5);
  EXPECT_NEAR(sum / count, 0.03, 0.01);
}

TEST(SlipWatch, GarbageLeavesItFinite) {
  const double garbage[] = {0, 1, -1, 1e-300, 1e3, -1e3, 1e6, 9.8};
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&] { return garbage[random() % std::size(garbage)]; };
    SlipWatch watch{SlipParams{}};
    for (int i = 0; i < 20000; ++i) {
      if (random() % 500 == 0) watch.restart_at_rest(pick());
      const SlipWatch::Sample sample{.dt = random() % 2 == 0 ? 0.005 : 0.2,
                                     .acceleration = {pick(), pick()},
                                     .up_x = 0.1,
                                     .yaw_rate = pick(),
                                     .travel = pick(),
                                     .speed = pick(),
                                     .both_sides_read = random() % 2 == 0};
      if (!watch.step(sample)) continue;
      ASSERT_TRUE(std::isfinite(watch.evaluate({.gravity_variance = 1e-3}, true))) << seed << ' ' << i;
      ASSERT_TRUE(std::isfinite(watch.level()) && std::isfinite(watch.speed_deviation())) << seed << ' ' << i;
      ASSERT_TRUE(std::isfinite(watch.gravity_error().along)) << seed << ' ' << i;
    }
  }
}

}  // namespace robot_control::tests
