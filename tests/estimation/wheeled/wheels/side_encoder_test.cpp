#include "estimation/wheeled/wheels/side_encoder.h"

#include <gtest/gtest.h>

#include "estimation/wheeled/rolling_robot.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr double kBandwidth = 20;  // Hz

/// The left wheel of a robot that stands at 12.5 rad.
struct SideEncoderTest : testing::Test {
  SideEncoderTest() {
    set_joints_valid(sensors_, kValidMotion);
    sensors_.joint_count = 2;
    EXPECT_EQ(read(12.5, 0), EncoderReading::kOffset);
  }
  EncoderReading read(double angle, double dt = kPeriod) {
    sensors_.joints[0].position = angle;
    return encoder_.step(sensors_, dt);
  }
  DriveTrain robot_ = two_wheeler();
  SideEncoder encoder_{robot_, Side::kLeft, kBandwidth, kPeriod};
  SensorFrame sensors_;
};

TEST_F(SideEncoderTest, TakesTheFirstReadingAsOffset) {
  EXPECT_EQ(encoder_.travel(), 0);
  EXPECT_TRUE(encoder_.known());
  EXPECT_TRUE(encoder_.received());
}

TEST_F(SideEncoderTest, TurnsAnglesIntoTravel) {
  EXPECT_EQ(read(12.51), EncoderReading::kTravel);
  EXPECT_NEAR(encoder_.travel(), 0.001, 1e-15);
  EXPECT_EQ(encoder_.time(), kPeriod);
}

TEST_F(SideEncoderTest, TurnsAMirroredWheelsAnglesAround) {
  robot_.wheels[0].sign = -1;
  SideEncoder mirrored(robot_, Side::kLeft, kBandwidth, kPeriod);
  mirrored.step(sensors_, 0);
  sensors_.joints[0].position = 12.51;
  mirrored.step(sensors_, kPeriod);
  EXPECT_NEAR(mirrored.travel(), -0.001, 1e-15);
}

TEST_F(SideEncoderTest, DoesNotLookAtTheOtherSide) {
  sensors_.joints[1].position = kNaN;
  EXPECT_EQ(read(12.51), EncoderReading::kTravel);
}

/// 0.1 m radius; left joints are mirrored.
struct SideEncoderOfFourWheels : testing::Test {
  SideEncoderOfFourWheels() {
    set_joints_valid(sensors_, kValidMotion);
    sensors_.joint_count = 4;
    EXPECT_EQ(left_.step(sensors_, 0), EncoderReading::kOffset);
    EXPECT_EQ(right_.step(sensors_, 0), EncoderReading::kOffset);
  }
  SideEncoder left_{four_wheeler(), Side::kLeft, kBandwidth, kPeriod};
  SideEncoder right_{four_wheeler(), Side::kRight, kBandwidth, kPeriod};
  SensorFrame sensors_;
};

// Left joints turn by −0.01 and −0.03 rad, right ones by 0.02 and 0.06 rad.
TEST_F(SideEncoderOfFourWheels, IsTheMeanOfItsSide) {
  constexpr double kAngles[] = {-0.01, -0.03, 0.02, 0.06};
  for (std::size_t i = 0; i < 4; ++i) sensors_.joints[i].position = kAngles[i];
  ASSERT_EQ(left_.step(sensors_, kPeriod), EncoderReading::kTravel);
  ASSERT_EQ(right_.step(sensors_, kPeriod), EncoderReading::kTravel);
  EXPECT_NEAR(left_.travel(), 0.002, 1e-15);
  EXPECT_NEAR(right_.travel(), 0.004, 1e-15);
}

TEST_F(SideEncoderOfFourWheels, OneWheelThatIsNotUsedRejectsTheReading) {
  sensors_.joints[1].position = kNaN;
  EXPECT_EQ(left_.step(sensors_, kPeriod), EncoderReading::kRejected);
  EXPECT_EQ(right_.step(sensors_, kPeriod), EncoderReading::kTravel);
}

// Without a limit a wheel turns by up to kNewZero more than at the last speed.
TEST_F(SideEncoderOfFourWheels, NeedsNoVelocityLimit) {
  sensors_.joints[0].position = Tuning::kNewZero - 0.01;
  EXPECT_EQ(left_.step(sensors_, kPeriod), EncoderReading::kTravel);
  sensors_.joints[0].position += 2 * Tuning::kNewZero + 0.01;
  EXPECT_EQ(left_.step(sensors_, kPeriod), EncoderReading::kRejected);
}

/// The parameter is the jump of a counter, rad, of wheels without a velocity limit at 100 Hz and 3 rad/s.
struct CounterThatBeginsAgain : SideEncoderOfFourWheels, testing::WithParamInterface<double> {};

// The bound on a jump does not widen with the time for which readings are rejected.
TEST_P(CounterThatBeginsAgain, HasNotTravelled) {
  constexpr double kGap = 0.01;
  const auto read = [&](double angle) {
    sensors_.joints[0].position = sensors_.joints[1].position = angle;
    return left_.step(sensors_, kGap);
  };
  double angle = 0;
  for (int i = 0; i < 100; ++i) ASSERT_EQ(read(angle += 0.03), EncoderReading::kTravel) << i;
  angle += GetParam();
  for (std::uint64_t i = 0; i < Tuning::kMaxHeld; ++i) ASSERT_EQ(read(angle += 0.03), EncoderReading::kRejected) << i;
  EXPECT_EQ(read(angle += 0.03), EncoderReading::kLost);
  EXPECT_EQ(read(angle += 0.03), EncoderReading::kTravel);
  EXPECT_NEAR(left_.travel(), -0.003, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Jumps, CounterThatBeginsAgain, testing::Values(-54.0, -20.0, -3.0, 1.5, 8.0, 42.0, 200.0));

TEST_F(SideEncoderTest, BringsTheTravelOfAGapWithTheNextGoodReading) {
  EXPECT_EQ(read(kNaN), EncoderReading::kRejected);
  EXPECT_EQ(encoder_.travel(), 0);
  EXPECT_FALSE(encoder_.received());
  EXPECT_EQ(encoder_.waiting(), kPeriod);
  EXPECT_EQ(read(12.52), EncoderReading::kTravel);
  EXPECT_NEAR(encoder_.travel(), 0.002, 1e-15);
  EXPECT_EQ(encoder_.time(), 2 * kPeriod);
  EXPECT_EQ(encoder_.gap(), 2 * kPeriod);
  EXPECT_TRUE(encoder_.received());
}

TEST_F(SideEncoderTest, RemembersNoGapBeyondItsBound) {
  EXPECT_EQ(read(12.52, 10 * Tuning::kMaxGap), EncoderReading::kTravel);
  EXPECT_EQ(encoder_.gap(), Tuning::kMaxGap);
}

TEST_F(SideEncoderTest, RejectsSamplesThatAreNotValid) {
  set_joints_valid(sensors_, 0);
  EXPECT_EQ(read(12.51), EncoderReading::kRejected);
}

TEST_F(SideEncoderTest, RejectsAFrameWithoutTheWheel) {
  sensors_.joint_count = 0;
  EXPECT_EQ(read(12.51), EncoderReading::kRejected);
}

// velocity_limit is 30 rad/s; twice that is possible.
TEST_F(SideEncoderTest, BelievesExactlyWhatIsPossible) {
  const double possible = 2 * 30 * kPeriod + Tuning::kEncoderSlack;
  EXPECT_EQ(read(12.5 + possible - 1e-3), EncoderReading::kTravel);
  EXPECT_EQ(read(12.5 + 2 * possible), EncoderReading::kRejected);
}

TEST_F(SideEncoderTest, TakesALastingJumpAsANewOffset) {
  for (std::uint64_t i = 0; i < Tuning::kMaxHeld; ++i) EXPECT_EQ(read(1000), EncoderReading::kRejected);
  EXPECT_EQ(read(1000), EncoderReading::kLost);
  EXPECT_EQ(encoder_.travel(), 0);
  EXPECT_EQ(read(1000.01), EncoderReading::kTravel);
  EXPECT_NEAR(encoder_.travel(), 0.001, 1e-13);
}

TEST_F(SideEncoderTest, AJumpThatDoesNotLastCostsNothing) {
  for (std::uint64_t i = 0; i < Tuning::kMaxHeld; ++i) read(1000);
  EXPECT_EQ(read(12.53), EncoderReading::kTravel);
  EXPECT_NEAR(encoder_.travel(), 0.003, 1e-15);
}

// Ten readings a second, in each of which the wheel might turn by 6 rad.
TEST_F(SideEncoderTest, AWheelThatBeginsAgainAtZeroHasNotTravelled) {
  for (int i = 0; i < 50; ++i) EXPECT_EQ(read(3.0, 0.3), EncoderReading::kTravel) << i;
  for (std::uint64_t i = 0; i < Tuning::kMaxHeld; ++i) EXPECT_EQ(read(0.05, 0.1), EncoderReading::kRejected) << i;
  EXPECT_EQ(read(0.05, 0.1), EncoderReading::kLost);
  EXPECT_EQ(encoder_.travel(), 0);
  EXPECT_EQ(read(0.06, 0.1), EncoderReading::kTravel);
}

TEST_F(SideEncoderTest, AZeroThatDoesNotLastCostsNothing) {
  for (int i = 0; i < 50; ++i) read(3.0, 0.3);
  EXPECT_EQ(read(0, 0.1), EncoderReading::kRejected);
  EXPECT_EQ(read(3.0, 0.1), EncoderReading::kTravel);
  EXPECT_EQ(encoder_.travel(), 0);
}

TEST_F(SideEncoderTest, AWheelThatTurnsBackToZeroHas) {
  for (double angle = 12.5; angle > -2; angle -= 0.5) EXPECT_EQ(read(angle, 0.1), EncoderReading::kTravel) << angle;
}

}  // namespace robot_control::tests
