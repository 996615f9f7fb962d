#include "drivers/mujoco/motors/motor.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr double kStall = 4;     // N·m
constexpr double kNoLoad = 200;  // rad/s, of the shaft
constexpr double kGear = 10;     // 20 rad/s at the wheel
constexpr double kTorqueRounding = 1e-14;

const Motor kMotor{kStall, kNoLoad, kGear};

TEST(MotorTest, HasItsWholeTorqueAtStandstill) {
  EXPECT_EQ(kMotor.limited(10, 0), kStall);
  EXPECT_EQ(kMotor.limited(-10, 0), -kStall);
  EXPECT_EQ(kMotor.limited(1.5, 0), 1.5);
}

TEST(MotorTest, LosesTorqueLinearlyWithSpeed) {
  for (const double speed : {2.0, 5.0, 10.0, 15.0}) {
    EXPECT_NEAR(kMotor.limited(10, speed), kStall * (1 - speed / 20), kTorqueRounding);
    EXPECT_NEAR(kMotor.limited(-10, -speed), -kStall * (1 - speed / 20), kTorqueRounding) << "backwards, too";
  }
}

TEST(MotorTest, DrivesNoFasterThanItsNoLoadSpeed) {
  EXPECT_EQ(kMotor.limited(10, 20), 0);
  EXPECT_EQ(kMotor.limited(10, 35), 0);
  EXPECT_EQ(kMotor.limited(-10, -35), 0);
}

TEST(MotorTest, BrakesWithItsWholeTorqueAtAnySpeed) {
  for (const double speed : {5.0, 20.0, 50.0}) {
    EXPECT_EQ(kMotor.limited(-10, speed), -kStall);
    EXPECT_EQ(kMotor.limited(10, -speed), kStall);
  }
}

TEST(MotorTest, PassesWhatItCanGive) {
  EXPECT_EQ(kMotor.limited(1.9, 10), 1.9);
  EXPECT_EQ(kMotor.limited(-3.9, 10), -3.9);
}

TEST(MotorTest, IsSlowerBehindAGreaterGear) {
  EXPECT_NEAR(Motor(kStall, kNoLoad, 20).limited(10, 5), kStall / 2, kTorqueRounding);
}

TEST(MotorTest, IsLimitedOnlyByItsStallTorqueWithoutANoLoadSpeed) {
  const Motor motor{kStall, 0, kGear};
  EXPECT_EQ(motor.limited(10, 1000), kStall);
  EXPECT_EQ(motor.limited(-10, -1000), -kStall);
}

}  // namespace robot_control::tests
