#include "control/wheeled/standstill.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/constants.h"

namespace robot_control::tests {

constexpr double kCount = 2 * std::numbers::pi / 4096;

TEST(Standstill, IsSeenAfterAQuarterOfASecondWithoutMotion) {
  Standstill standstill(kPeriod);
  for (std::uint64_t k = 0; k < 250; ++k) {
    standstill.step({7, -3}, k);
    ASSERT_FALSE(standstill.standing()) << "cycle " << k;
  }
  standstill.step({7, -3}, 250);
  EXPECT_TRUE(standstill.standing());
}

TEST(Standstill, IsNotDisturbedByAFlickeringEncoderCount) {
  Standstill standstill(kPeriod);
  for (std::uint64_t k = 0; k <= 250; ++k) standstill.step({k % 2 ? kCount : 0, 0}, k);
  EXPECT_TRUE(standstill.standing());
}

TEST(Standstill, EndsWhenEitherWheelLeavesTheWindow) {
  for (const bool left : {true, false}) {
    Standstill standstill(kPeriod);
    for (std::uint64_t k = 0; k <= 250; ++k) standstill.step({}, k);
    const double window = kStandstillSpeed * kStandstillTime;
    standstill.step({left ? window : 0, left ? 0 : -window}, 251);
    EXPECT_FALSE(standstill.standing());
  }
}

TEST(Standstill, IsNeverSeenAboveTheThresholdSpeed) {
  Standstill standstill(kPeriod);
  for (std::uint64_t k = 0; k < 5000; ++k) {
    standstill.step({0, 1.05 * kStandstillSpeed * static_cast<double>(k) * kPeriod}, k);
    ASSERT_FALSE(standstill.standing()) << "cycle " << k;
  }
}

TEST(Standstill, ForgetsWhenReset) {
  Standstill standstill(kPeriod);
  for (std::uint64_t k = 0; k <= 250; ++k) standstill.step({}, k);
  standstill.reset();
  EXPECT_FALSE(standstill.standing());
  standstill.step({}, 1000);
  EXPECT_FALSE(standstill.standing());
}

}  // namespace robot_control::tests
