#include "estimation/inertial/standstill_window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/constants.h"

namespace robot_control {
namespace {

constexpr int kLength = 250;  // cycles, StandstillLimits::time

/// Stands, in cycles of 1 ms; the gyro reads 0.01, 0.02, 0.03 rad/s, the accelerometer gravity.
class StandstillWindowTest : public testing::Test {
 protected:
  StandstillWindowTest() {
    sample_.dt = kPeriod;
    sample_.gyro = Eigen::Vector3d(0.01, 0.02, 0.03);
    sample_.accelerometer = Eigen::Vector3d(0, 0, 9.80665);
  }
  WindowEnd wait(int cycles) {
    WindowEnd end = WindowEnd::kOpen;
    for (int i = 0; i < cycles; ++i) end = window_.step(sample_);
    return end;
  }
  StandstillLimits limits_;
  StandstillWindow window_{limits_};
  StandstillSample sample_;
};

TEST_F(StandstillWindowTest, IsQuietAfterItsWholeLength) {
  EXPECT_EQ(wait(kLength - 1), WindowEnd::kOpen);
  EXPECT_EQ(wait(1), WindowEnd::kQuiet);
  EXPECT_NEAR(window_.time(), limits_.time, 1e-9);
}

TEST_F(StandstillWindowTest, WindowsFollowEachOther) {
  for (int i = 1; i <= 4; ++i) {
    EXPECT_EQ(wait(kLength - 1), WindowEnd::kOpen) << i;
    EXPECT_EQ(wait(1), WindowEnd::kQuiet) << i;
  }
}

TEST_F(StandstillWindowTest, TellsTheMeans) {
  for (int i = 0; i < kLength; ++i) {
    sample_.gyro = Eigen::Vector3d(0.01, 0.02, i % 2 == 0 ? 0.02 : 0.04);
    sample_.accelerometer = Eigen::Vector3d(i % 2 == 0 ? -0.1 : 0.1, 0, 9.80665);
    window_.step(sample_);
  }
  // Deviations from the first sample are summed: rounding of 250 additions.
  EXPECT_LT((*window_.gyro() - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 1e-15 * kLength);
  EXPECT_LT((*window_.accelerometer() - Eigen::Vector3d(0, 0, 9.80665)).norm(), 1e-14 * kLength);
}

TEST_F(StandstillWindowTest, EndsAtOnceWhenAWheelLeavesItsTolerance) {
  wait(100);
  sample_.left = 0.9 * limits_.tolerance;
  EXPECT_EQ(wait(1), WindowEnd::kOpen);
  sample_.left = 0.2 * limits_.tolerance;
  EXPECT_EQ(wait(1), WindowEnd::kBroken);
  sample_.left = 0;
  EXPECT_EQ(wait(kLength - 1), WindowEnd::kOpen) << "a new window began";
  EXPECT_EQ(wait(1), WindowEnd::kQuiet);
}

TEST_F(StandstillWindowTest, TheRightWheelEndsItToo) {
  sample_.right = -1.1 * limits_.tolerance;
  EXPECT_EQ(wait(1), WindowEnd::kBroken);
}

TEST_F(StandstillWindowTest, AWheelMayFlickerWithinItsTolerance) {
  WindowEnd end = WindowEnd::kOpen;
  for (int i = 0; i < kLength; ++i) {
    sample_.left = (i % 2 == 0 ? 0.9 : -0.9) * limits_.tolerance;
    end = window_.step(sample_);
  }
  EXPECT_EQ(end, WindowEnd::kQuiet);
  EXPECT_NEAR(window_.left(), 0, 1e-12);
}

// Creeping at a tolerance per window is not noticed; the travel is told.
TEST_F(StandstillWindowTest, TellsTheTravel) {
  sample_.left = 0.8 * limits_.tolerance / kLength;
  sample_.right = -0.5 * limits_.tolerance / kLength;
  EXPECT_EQ(wait(kLength), WindowEnd::kQuiet);
  EXPECT_NEAR(window_.left(), 0.8 * limits_.tolerance, 1e-12);
  EXPECT_NEAR(window_.right(), -0.5 * limits_.tolerance, 1e-12);
}

// ± a has RMS a.
TEST_F(StandstillWindowTest, AnAccelerometerThatIsNotQuietIsSaid) {
  for (const double factor : {0.99, 1.01}) {
    WindowEnd end = WindowEnd::kOpen;
    for (int i = 0; i < kLength; ++i) {
      const double shake = factor * limits_.acceleration * (i % 2 == 0 ? 1 : -1);
      sample_.accelerometer = Eigen::Vector3d(shake, 0, 9.80665);
      end = window_.step(sample_);
    }
    EXPECT_EQ(end, factor < 1 ? WindowEnd::kQuiet : WindowEnd::kShaken);
  }
}

TEST_F(StandstillWindowTest, NeedsNeitherGyroNorAccelerometer) {
  sample_.gyro.reset();
  sample_.accelerometer.reset();
  EXPECT_EQ(wait(kLength), WindowEnd::kQuiet);
  EXPECT_FALSE(window_.gyro().has_value());
  EXPECT_FALSE(window_.accelerometer().has_value());
}

TEST_F(StandstillWindowTest, MeansOfSparseSamplesAreTheirOwn) {
  for (int i = 0; i < kLength; ++i) {
    StandstillSample sample{.dt = kPeriod, .left = 0, .right = 0, .gyro = {}, .accelerometer = {}};
    if (i % 5 == 0) sample.gyro = sample_.gyro;
    window_.step(sample);
  }
  EXPECT_LT((*window_.gyro() - *sample_.gyro).norm(), 1e-15);
  EXPECT_FALSE(window_.accelerometer().has_value());
}

TEST_F(StandstillWindowTest, AResetBeginsAnew) {
  wait(kLength - 1);
  window_.reset();
  EXPECT_EQ(wait(kLength - 1), WindowEnd::kOpen);
  EXPECT_EQ(wait(1), WindowEnd::kQuiet);
}

// Ten minutes of the same bias: small numbers keep their digits.
TEST_F(StandstillWindowTest, LosesNoDigitsToALargeMean) {
  sample_.accelerometer = Eigen::Vector3d(1e3, 0, 9.80665);
  for (int i = 0; i < 600; ++i) ASSERT_EQ(wait(kLength), WindowEnd::kQuiet);
  EXPECT_EQ(*window_.accelerometer(), *sample_.accelerometer);
}

}  // namespace
}  // namespace robot_control
