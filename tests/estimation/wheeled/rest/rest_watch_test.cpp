// Detects by wheels and gyro alone whether the robot stands.

#include "estimation/wheeled/rest/rest_watch.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

struct RestWatchTest : testing::Test {
  static constexpr double kStep = 0.01;  // s
  static constexpr int kWindow = 25;     // steps

  RestWindow step(double rate, double left = 0, double right = 0) {
    const Vector3 gyro{0, 0, rate};
    const Vector3 force{0.1, 0, 9.8};
    return watch_.step({.dt = kStep, .left = left, .right = right, .gyro = gyro, .accelerometer = force}, bias_);
  }
  /// The verdict of a whole window at a constant rate.
  RestWindow window(double rate) {
    for (int i = 0; i < kWindow - 1; ++i) EXPECT_EQ(step(rate), RestWindow::kOpen) << i;
    return step(rate);
  }
  RestWatchParams params_;
  RestWatch::Bias bias_{.deviation = {1e-3, 1e-3, 1e-3}};
  RestWatch watch_{params_};
};

// A robot may have begun to move at the end of a window.
TEST_F(RestWatchTest, TheMeansOfAQuietWindowCountBehindTheNextOne) {
  EXPECT_EQ(window(0.004), RestWindow::kQuiet);
  EXPECT_FALSE(watch_.means().gyro.has_value());
  EXPECT_EQ(window(0.002), RestWindow::kQuiet);
  EXPECT_NEAR(watch_.means().time, params_.window, 1e-12);
  EXPECT_NEAR((*watch_.means().gyro)[2], 0.004, 1e-12);
  EXPECT_NEAR((*watch_.means().accelerometer)[2], 9.8, 1e-12);
  EXPECT_FALSE(watch_.bias_changed());
}

TEST_F(RestWatchTest, EndsAtOnceWhereAWheelLeavesItsTolerance) {
  EXPECT_EQ(step(0, 0, 0.9 * params_.tolerance), RestWindow::kOpen);
  EXPECT_EQ(step(0, 0, 0.2 * params_.tolerance), RestWindow::kBroken);
  EXPECT_EQ(window(0), RestWindow::kQuiet) << "the next one begins there";
}

TEST_F(RestWatchTest, TheMeansBeforeABrokenWindowDoNotCount) {
  window(0.004);
  step(0, 1, 1);
  window(0.002);
  EXPECT_FALSE(watch_.means().gyro.has_value());
  window(0);
  EXPECT_NEAR((*watch_.means().gyro)[2], 0.002, 1e-12);
}

TEST_F(RestWatchTest, AWindowThatIsDiscardedDoesNotCount) {
  window(0.004);
  watch_.discard();
  window(0.002);
  EXPECT_FALSE(watch_.means().gyro.has_value());
}

TEST_F(RestWatchTest, AWheelThatFlickersWithinItsToleranceIsQuiet) {
  for (int i = 0; i < kWindow - 1; ++i) step(0, i % 2 == 0 ? params_.tolerance : -params_.tolerance);
  EXPECT_EQ(step(0), RestWindow::kQuiet);
}

// The limit is `steady` and three deviations.
TEST_F(RestWatchTest, ATurnOnWheelsThatStandIsNoRest) {
  EXPECT_EQ(window(0.0125), RestWindow::kQuiet);
  EXPECT_EQ(window(0.0135), RestWindow::kTurned);
}

TEST_F(RestWatchTest, TheRateIsThatBesideTheKnownBias) {
  bias_.value = {0, 0, 0.1};
  EXPECT_EQ(window(0.1), RestWindow::kQuiet);
  EXPECT_EQ(window(0), RestWindow::kTurned);
}

// One side creeps forwards and one backwards by half a tolerance.
TEST_F(RestWatchTest, TheMeanIsLessWhatTheWheelsTurned) {
  const double creep = 0.5 * params_.tolerance / kWindow;
  const double rate = 2 * creep * params_.turn_per_metre / kStep;
  for (int i = 0; i < kWindow - 1; ++i) step(rate, -creep, creep);
  ASSERT_EQ(step(rate, -creep, creep), RestWindow::kQuiet);
  window(0.004);
  EXPECT_NEAR((*watch_.means().gyro)[2], 0, 1e-12);
}

// Nothing turns a robot so evenly on wheels that stand.
TEST_F(RestWatchTest, ARateThatStaysForTenSecondsIsTheBias) {
  double time = 0;
  while (window(0.3) == RestWindow::kTurned) {
    time += params_.window;
    ASSERT_LT(time, 2 * Tuning::kConstantRate);
  }
  EXPECT_NEAR(time + params_.window, Tuning::kConstantRate, 1e-9);
  EXPECT_TRUE(watch_.bias_changed());
  EXPECT_NEAR((*watch_.means().gyro)[2], 0.3, 1e-12);
}

TEST_F(RestWatchTest, ARateThatChangesIsNone) {
  for (int i = 0; i < 200; ++i) EXPECT_EQ(window(i % 20 < 10 ? 0.3 : 0.32), RestWindow::kTurned) << i;
}

// The body still swings after a stop, or turns on wheels that stand.
TEST_F(RestWatchTest, ARestIsSteadyForASecondWhereNoBiasIsKnown) {
  bias_.known = false;
  for (const double rate : {0.0265, 0.0209, 0.0089, -0.0014, -0.0065, -0.0065, -0.0065}) {
    EXPECT_EQ(window(rate), RestWindow::kTurned) << rate;
  }
  EXPECT_EQ(window(-0.0060), RestWindow::kQuiet);
  EXPECT_TRUE(watch_.bias_changed());
  EXPECT_NEAR((*watch_.means().gyro)[2], -0.0065, 1e-12);
}

TEST_F(RestWatchTest, ALouderGyroTakesTenSecondsWhereNoBiasIsKnown) {
  bias_.known = false;
  double time = 0;
  for (int i = 0; window(i % 2 == 0 ? 0.004 : -0.004) == RestWindow::kTurned; ++i) {
    time += params_.window;
    ASSERT_LT(time, 2 * Tuning::kConstantRate);
  }
  EXPECT_NEAR(time + params_.window, Tuning::kConstantRate, 1e-9);
}

TEST_F(RestWatchTest, AWheelThatMovesBeginsTheTenSecondsAnew) {
  for (int i = 0; i < 38; ++i) window(0.3);
  step(0.3, 1, 1);
  for (int i = 0; i < 38; ++i) EXPECT_EQ(window(0.3), RestWindow::kTurned) << i;
}

TEST_F(RestWatchTest, TheWheelsDecideWithoutGyro) {
  for (int i = 0; i < kWindow - 1; ++i) watch_.step({.dt = kStep}, bias_);
  EXPECT_EQ(watch_.step({.dt = kStep}, bias_), RestWindow::kQuiet);
  window(0);
  EXPECT_NEAR(watch_.means().time, params_.window, 1e-12);
  EXPECT_FALSE(watch_.means().gyro.has_value());
  EXPECT_FALSE(watch_.means().accelerometer.has_value());
}

// A gyro that came for less than half of the window has no mean.
TEST_F(RestWatchTest, AMeanIsThatOfHalfAWindowAtLeast) {
  for (int i = 0; i < 10; ++i) step(5.0);
  for (int i = 10; i < kWindow - 1; ++i) watch_.step({.dt = kStep}, bias_);
  EXPECT_EQ(watch_.step({.dt = kStep}, bias_), RestWindow::kQuiet);
  window(0);
  EXPECT_FALSE(watch_.means().gyro.has_value());
}

TEST_F(RestWatchTest, AnAccelerometerThatShakesIsNoMotion) {
  const Vector3 gyro{};
  for (int i = 0; i < kWindow; ++i) {
    const Vector3 force{i % 2 == 0 ? 20.0 : -20.0, 0, 9.8};
    const RestWindow verdict = watch_.step({.dt = kStep, .gyro = gyro, .accelerometer = force}, bias_);
    EXPECT_EQ(verdict, i + 1 < kWindow ? RestWindow::kOpen : RestWindow::kQuiet);
  }
}

TEST_F(RestWatchTest, AResetBeginsANewWindow) {
  for (int i = 0; i < kWindow - 1; ++i) step(0);
  watch_.reset();
  EXPECT_EQ(window(0), RestWindow::kQuiet);
}

}  // namespace robot_control::tests
