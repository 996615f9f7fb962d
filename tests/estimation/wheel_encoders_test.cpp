#include "estimation/wheel_encoders.h"

#include <gtest/gtest.h>

#include <limits>

#include "estimation/planar_robot.h"

namespace robot_control {
namespace {

constexpr double kPeriod = 1e-3;

class WheelEncodersTest : public testing::Test {
 protected:
  WheelEncodersTest() {
    sensors_.valid = kValidJoints;
    sensors_.joint_count = 2;
    set(12.5, -3.0);
    EXPECT_EQ(encoders_.step(sensors_, 0), EncoderReading::kOffset);
  }
  void set(double left, double right) {
    sensors_.joints[0].position = left;
    sensors_.joints[1].position = right;
  }
  RobotModel robot_ = two_wheeler();
  WheelEncoders encoders_{robot_};
  SensorFrame sensors_;
};

TEST_F(WheelEncodersTest, TakesTheFirstReadingAsOffset) {
  EXPECT_EQ(encoders_.left(), 0);
  EXPECT_EQ(encoders_.right(), 0);
}

TEST_F(WheelEncodersTest, TurnsAnglesIntoTravel) {
  set(12.51, -3.02);
  EXPECT_EQ(encoders_.step(sensors_, kPeriod), EncoderReading::kTravel);
  EXPECT_NEAR(encoders_.left(), 0.001, 1e-15);
  EXPECT_NEAR(encoders_.right(), -0.002, 1e-15);
}

TEST_F(WheelEncodersTest, TurnsAMirroredWheelsAnglesAround) {
  robot_.right.sign = -1;
  WheelEncoders mirrored(robot_);
  mirrored.step(sensors_, 0);
  set(12.51, -3.01);
  mirrored.step(sensors_, kPeriod);
  EXPECT_NEAR(mirrored.right(), 0.001, 1e-15);
}

TEST_F(WheelEncodersTest, BringsTheTravelOfAGapWithTheNextGoodReading) {
  set(std::numeric_limits<double>::quiet_NaN(), -3.0);
  EXPECT_EQ(encoders_.step(sensors_, kPeriod), EncoderReading::kRejected);
  set(12.52, -2.98);
  EXPECT_EQ(encoders_.step(sensors_, 2 * kPeriod), EncoderReading::kTravel);
  EXPECT_NEAR(encoders_.left(), 0.002, 1e-15);
  EXPECT_NEAR(encoders_.right(), 0.002, 1e-15);
}

TEST_F(WheelEncodersTest, RejectsSamplesThatAreNotValid) {
  sensors_.valid = 0;
  EXPECT_EQ(encoders_.step(sensors_, kPeriod), EncoderReading::kRejected);
}

TEST_F(WheelEncodersTest, RejectsAFrameWithoutTheWheel) {
  sensors_.joint_count = 1;
  EXPECT_EQ(encoders_.step(sensors_, kPeriod), EncoderReading::kRejected);
}

// velocity_limit is 30 rad/s, so 2 · 30 · 0.001 + 0.1 = 0.16 rad is possible in a cycle.
TEST_F(WheelEncodersTest, BelievesExactlyWhatIsPossible) {
  set(12.5 + 0.159, -3.0);
  EXPECT_EQ(encoders_.step(sensors_, kPeriod), EncoderReading::kTravel);
  set(12.5 + 0.159 + 0.161, -3.0);
  EXPECT_EQ(encoders_.step(sensors_, kPeriod), EncoderReading::kRejected);
}

TEST_F(WheelEncodersTest, TakesALastingJumpAsANewOffset) {
  set(1000, -3.0);
  for (std::uint64_t i = 0; i < WheelEncoders::kMaxRejected; ++i) {
    EXPECT_EQ(encoders_.step(sensors_, static_cast<double>(i + 1) * kPeriod), EncoderReading::kRejected);
  }
  EXPECT_EQ(encoders_.step(sensors_, 5 * kPeriod), EncoderReading::kLost);
  EXPECT_EQ(encoders_.left(), 0);
  set(1000.01, -3.0);
  EXPECT_EQ(encoders_.step(sensors_, kPeriod), EncoderReading::kTravel);
  EXPECT_NEAR(encoders_.left(), 0.001, 1e-13);
}

}  // namespace
}  // namespace robot_control
