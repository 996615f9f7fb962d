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
  robot_.wheels[1].sign = -1;
  WheelEncoders mirrored(robot_);
  mirrored.step(sensors_, 0);
  set(12.51, -3.01);
  mirrored.step(sensors_, kPeriod);
  EXPECT_NEAR(mirrored.right(), 0.001, 1e-15);
}

// 0.1 m radius: +0.01 and +0.03 rad of mirrored left joints, 0.02 and 0.06 rad right.
TEST(WheelEncodersOfFourWheels, AreTheMeanOfEachSide) {
  const RobotModel robot = four_wheeler();
  WheelEncoders encoders(robot);
  SensorFrame sensors;
  sensors.valid = kValidJoints;
  sensors.joint_count = 4;
  ASSERT_EQ(encoders.step(sensors, 0), EncoderReading::kOffset);
  constexpr double kAngles[] = {-0.01, -0.03, 0.02, 0.06};
  for (std::size_t i = 0; i < 4; ++i) sensors.joints[i] = {.position = kAngles[i], .velocity = 10 * kAngles[i]};
  ASSERT_EQ(encoders.step(sensors, kPeriod), EncoderReading::kTravel);
  EXPECT_NEAR(encoders.left(), 0.002, 1e-15);
  EXPECT_NEAR(encoders.right(), 0.004, 1e-15);
  EXPECT_NEAR(encoders.left_speed(sensors), 0.02, 1e-15);
  EXPECT_NEAR(encoders.right_speed(sensors), 0.04, 1e-15);
  sensors.joints[1].position = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(encoders.step(sensors, kPeriod), EncoderReading::kRejected) << "one wheel rejects all";
}

// Without a limit a wheel is believed up to 1000 rad/s: 1.1 rad in a cycle, slack included.
TEST(WheelEncodersOfFourWheels, NeedNoVelocityLimit) {
  const RobotModel robot = four_wheeler();
  WheelEncoders encoders(robot);
  SensorFrame sensors;
  sensors.valid = kValidJoints;
  sensors.joint_count = 4;
  encoders.step(sensors, 0);
  sensors.joints[0].position = 1.09;
  EXPECT_EQ(encoders.step(sensors, kPeriod), EncoderReading::kTravel);
  sensors.joints[0].position += 1.11;
  EXPECT_EQ(encoders.step(sensors, kPeriod), EncoderReading::kRejected);
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
