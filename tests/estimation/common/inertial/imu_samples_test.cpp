#include "estimation/common/inertial/imu_samples.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "estimation/common/values.h"
#include "support/constants.h"

namespace robot_control::tests {

/// A gyro and an accelerometer have given their first samples: 0.1 rad/s and 1 m/s² along z.
struct ImuSamplesTest : testing::Test {
  ImuSamplesTest() { both(0.1, 1.0, 0); }

  void none(double dt = kPeriod) { step(0, {}, {}, dt); }
  void gyro(double z, double dt = kPeriod) { step(kValidGyro, {0, 0, z}, {}, dt); }
  void accelerometer(double z, double dt = kPeriod) { step(kValidAccelerometer, {}, {0, 0, z}, dt); }
  void both(double rate, double force, double dt = kPeriod) {
    step(kValidGyro | kValidAccelerometer, {0, 0, rate}, {0, 0, force}, dt);
  }
  void step(std::uint64_t valid, const Vector3& rate, const Vector3& force, double dt) {
    SensorFrame frame;
    frame.valid = valid;
    frame.imu.angular_velocity = rate;
    frame.imu.linear_acceleration = force;
    reading_ = imu_.step(frame, base_from_imu_, dt);
  }
  double rate() const { return reading_.gyro.value()[2]; }

  Eigen::Matrix3d base_from_imu_ = Eigen::Matrix3d::Identity();
  ImuSamples imu_;
  ImuReading reading_;
};

TEST_F(ImuSamplesTest, TheFirstSampleIsItsOwnMean) {
  EXPECT_EQ(rate(), 0.1);
  EXPECT_EQ((*reading_.accelerometer)[2], 1.0);
  EXPECT_TRUE(reading_.fresh_gyro);
}

TEST_F(ImuSamplesTest, TheGyroIsTheMeanOfBothEndsOfTheStep) {
  gyro(0.3);
  EXPECT_DOUBLE_EQ(rate(), 0.2);
}

TEST_F(ImuSamplesTest, TheAccelerometerIsTheSampleItself) {
  accelerometer(3.0);
  EXPECT_EQ((*reading_.accelerometer)[2], 3.0);
}

// Steps without a sample use the last one; the step with the next sample completes the trapezoid.
TEST_F(ImuSamplesTest, TheIntegralOverIrregularGapsIsTheTrapezoidOfTheSamples) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-2, 2);
  std::uniform_real_distribution<double> duration(0.5e-3, 1.5e-3);
  double expected = 0;
  double integral = 0;
  double last = 0.1;
  for (int sample = 0; sample < 1000; ++sample) {
    double gap = 0;
    for (unsigned silent = random() % 4; silent > 0; --silent) {
      const double dt = duration(random);
      none(dt);
      integral += rate() * dt;
      gap += dt;
    }
    const double dt = duration(random);
    const double next = value(random);
    gyro(next, dt);
    integral += rate() * dt;
    expected += (last + next) / 2 * (gap + dt);
    last = next;
    ASSERT_NEAR(integral, expected, 1e-12) << "sample " << sample;  // 4000 additions of numbers below 1e-2
  }
}

TEST_F(ImuSamplesTest, AGapLongerThanTheHoldIsNotBridged) {
  gyro(0.1);
  gyro(0.5, 2 * Tuning::kMaxHoldTime);
  EXPECT_FALSE(reading_.gyro.has_value());  // neither sample covers all that time
  gyro(0.5);
  EXPECT_EQ(rate(), 0.5);
}

TEST_F(ImuSamplesTest, ASampleHoldsForTheShortHoldAtLeast) {
  gyro(0.2);  // a gap of 1 ms: three of them are less
  none(0.99 * Tuning::kMinHoldTime);
  EXPECT_EQ(rate(), 0.2);
  EXPECT_FALSE(reading_.fresh_gyro);
  none(0.02 * Tuning::kMinHoldTime);
  EXPECT_FALSE(reading_.gyro.has_value());
}

TEST_F(ImuSamplesTest, ASampleHoldsForThreeTimesTheLastGap) {
  const double gap = 0.7 * Tuning::kMinHoldTime;
  gyro(0.2, gap);
  none(2.9 * gap);
  EXPECT_TRUE(reading_.gyro.has_value());
  none(0.2 * gap);
  EXPECT_FALSE(reading_.gyro.has_value());
}

TEST_F(ImuSamplesTest, ASampleHoldsForTheLongHoldAtMost) {
  gyro(0.2, 0.9 * Tuning::kMaxHoldTime);
  none(0.99 * Tuning::kMaxHoldTime);
  EXPECT_TRUE(reading_.gyro.has_value());
  none(0.02 * Tuning::kMaxHoldTime);
  EXPECT_FALSE(reading_.gyro.has_value());
}

// The first gap ends beyond the short hold: it must be learned nevertheless.
TEST_F(ImuSamplesTest, ASensorSlowerThanTheShortHoldIsHeldFromItsSecondSampleOn) {
  constexpr int kRows = 5;
  constexpr double kGap = 2 * Tuning::kMinHoldTime;
  for (int sample = 0; sample < 4; ++sample) {
    for (int row = 1; row < kRows; ++row) {
      none(kGap / kRows);
      EXPECT_TRUE(sample == 0 || reading_.gyro.has_value()) << "sample " << sample << ", row " << row;
    }
    both(0.1, 1.0, kGap / kRows);
  }
}

TEST_F(ImuSamplesTest, TheRateIsTheSampleWhereTheMeanMakesGoodForEarlierSteps) {
  gyro(0.2);
  EXPECT_EQ(reading_.rate[2], rate());
  none(0.01);
  EXPECT_EQ(reading_.rate[2], rate());
  gyro(0.3, 1e-5);
  EXPECT_GT(rate(), 10);  // 0.05 rad/s over 10 ms, made good within 10 µs
  EXPECT_EQ(reading_.rate[2], 0.3);
  gyro(0.3);
  EXPECT_EQ(reading_.rate[2], rate());
}

TEST_F(ImuSamplesTest, AnAccelerometerWithLongGapsSaysNothingOfTheMotionBetween) {
  accelerometer(1.0, 1.01 * Tuning::kSlowAccelerometer);
  accelerometer(1.0, 1.01 * Tuning::kSlowAccelerometer);
  EXPECT_FALSE(reading_.accelerometer.has_value());
  accelerometer(1.0);
  EXPECT_TRUE(reading_.accelerometer.has_value());
}

TEST_F(ImuSamplesTest, TheHoldsOfBothSensorsAreTheirOwn) {
  for (int i = 0; i < 30; ++i) gyro(0.1);  // 30 ms
  EXPECT_TRUE(reading_.gyro.has_value());
  EXPECT_FALSE(reading_.accelerometer.has_value());
}

TEST_F(ImuSamplesTest, ALostSensorComesBackWithItsNextSample) {
  none(1);
  ASSERT_FALSE(reading_.gyro.has_value());
  both(0.7, 2.0);
  EXPECT_EQ(rate(), 0.7);
  both(0.7, 2.0);
  EXPECT_EQ((*reading_.accelerometer)[2], 2.0) << "with two: one after a long gap may be a slow sensor's";
}

// The motion between its samples is not known.
TEST_F(ImuSamplesTest, ASlowAccelerometerIsNone) {
  for (int i = 0; i < 10; ++i) accelerometer(1.0, 0.9 * Tuning::kSlowAccelerometer);
  EXPECT_TRUE(reading_.accelerometer.has_value());
  for (int i = 0; i < 10; ++i) accelerometer(1.0, 1.1 * Tuning::kSlowAccelerometer);
  EXPECT_FALSE(reading_.accelerometer.has_value());
}

// Otherwise a gyro slower than the shortest hold would be lost permanently.
TEST_F(ImuSamplesTest, AGyroSlowerThanTheShortHoldIsFoundOut) {
  const double gap = 1.5 * Tuning::kMinHoldTime;
  for (int i = 0; i < 4; ++i) gyro(0.2, gap);
  none(gap);
  EXPECT_TRUE(reading_.gyro.has_value());
}

TEST_F(ImuSamplesTest, WhatIsNotFiniteIsNoSample) {
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300}) {
    imu_ = {};
    both(0.1, 1.0, 0);
    step(kValidGyro | kValidAccelerometer, {0, bad, 0}, {bad, 0, 0}, kPeriod);
    EXPECT_TRUE(reading_.refused);
    EXPECT_FALSE(reading_.fresh_gyro);
    EXPECT_EQ(rate(), 0.1) << "the last one holds";
    EXPECT_EQ((*reading_.accelerometer)[2], 1.0);
    gyro(0.1);
    EXPECT_FALSE(reading_.refused);
  }
}

TEST_F(ImuSamplesTest, WhatIsBeyondItsRangeIsNoSample) {
  gyro(0.999 * Tuning::kGyroRange);
  EXPECT_FALSE(reading_.refused);
  gyro(1.001 * Tuning::kGyroRange);
  EXPECT_TRUE(reading_.refused);
  accelerometer(0.999 * Tuning::kAccelerometerRange);
  EXPECT_FALSE(reading_.refused);
  accelerometer(1.001 * Tuning::kAccelerometerRange);
  EXPECT_TRUE(reading_.refused);
}

TEST_F(ImuSamplesTest, WhatIsNotOfferedIsNotRefused) {
  step(0, {kNaN, 0, 0}, {kNaN, 0, 0}, kPeriod);
  EXPECT_FALSE(reading_.refused);
}

// A quarter turn about z points the IMU's x to the left.
TEST_F(ImuSamplesTest, SamplesAreInBaseAxes) {
  base_from_imu_ = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  imu_ = {};
  step(kValidGyro | kValidAccelerometer, {1, 2, 3}, {4, 5, 6}, 0);
  EXPECT_TRUE(vector(*reading_.gyro).isApprox(Eigen::Vector3d(-2, 1, 3)));
  EXPECT_TRUE(vector(*reading_.accelerometer).isApprox(Eigen::Vector3d(-5, 4, 6)));
}

TEST_F(ImuSamplesTest, AResetForgets) {
  imu_ = {};
  none();
  EXPECT_FALSE(reading_.gyro.has_value());
  EXPECT_FALSE(reading_.accelerometer.has_value());
}

}  // namespace robot_control::tests
