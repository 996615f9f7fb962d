#include "drivers/cia402/drive_units.h"

#include <gtest/gtest.h>

namespace robot_control::cia402::tests {

constexpr DriveUnits kUnits{.rated_torque = 2.5, .counts_per_turn = 4096};

TEST(DriveUnits, TorqueIsInThousandthsOfTheRated) {
  EXPECT_DOUBLE_EQ(kUnits.torque(-200), -0.5);
  EXPECT_EQ(kUnits.raw_torque(0.5), 200);
  EXPECT_EQ(kUnits.raw_torque(0.00124), 0);
  EXPECT_EQ(kUnits.raw_torque(0.00126), 1);
}

TEST(DriveUnits, ATorqueBeyondTheRangeSaturatesAndNaNIsNone) {
  EXPECT_EQ(kUnits.raw_torque(1e9), 32767);
  EXPECT_EQ(kUnits.raw_torque(-std::numeric_limits<double>::infinity()), -32768);
  EXPECT_EQ(kUnits.raw_torque(std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(DriveUnits, PositionsAndVelocitiesAreSi) {
  EXPECT_DOUBLE_EQ(kUnits.position(1024), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(kUnits.velocity(60), 2 * std::numbers::pi);
}

TEST(DriveUnits, ObjectsInThousandthsAreSi) {
  EXPECT_DOUBLE_EQ(rated_torque(1270), 1.27);
  EXPECT_DOUBLE_EQ(dc_link_voltage(48'000), 48);
}

// The values of Synapticon's and Nanotec's manuals.
TEST(DriveUnits, ReadTheUnitOfTheVelocity) {
  EXPECT_DOUBLE_EQ(velocity_unit(0x00B4'4700), kRpm);
  EXPECT_DOUBLE_EQ(velocity_unit(0xFDB4'4700), 0.001 * kRpm);
  EXPECT_DOUBLE_EQ(velocity_unit(0x00B4'0300), 2 * std::numbers::pi);
  EXPECT_EQ(velocity_unit(0x00B5'0300), 0) << "increments per second";
  EXPECT_EQ(velocity_unit(0), 0);
}

}  // namespace robot_control::cia402::tests
