#include "control/wheeled/wheel_loops/speed_lead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace robot_control::tests {

constexpr double kLeadPeriod = 1.0e-3;
constexpr double kResponse = 0.05;  // s
constexpr double kTop = 5;          // rad/s, at the end of the ramp
constexpr double kRamp = 10;        // rad/s²

/// This is what the ramp gains in two periods and a half, by kTop: the ramp ends, and the drive acts, once in a period.
constexpr double kPeriods = 2.5 * kRamp * kLeadPeriod / kTop;

/// A drive with the integral time 4 · kResponse, whose gains are those of kResponse times `gain`. Returns by how much
/// of kTop it overshoots a ramp.
double overshoot(double lead_time, double gain) {
  SpeedLead lead(lead_time, kLeadPeriod);
  double plan = 0, speed = 0, integral = 0, fastest = 0;
  for (int i = 0; i < 3000; ++i) {
    const double acceleration = plan < kTop ? kRamp : 0;
    plan = std::min(kTop, plan + acceleration * kLeadPeriod);
    const double error = lead.step(plan, acceleration, 1) - speed;
    integral += error * kLeadPeriod / (4 * kResponse);
    speed += gain * (error + integral) / kResponse * kLeadPeriod;
    fastest = std::max(fastest, speed);
  }
  return fastest / kTop - 1;
}

TEST(SpeedLead, ADriveWithThisResponseDoesNotOvershootARamp) {
  EXPECT_GT(overshoot(0, 1), 0.06);
  EXPECT_LT(overshoot(kResponse, 1), kPeriods);
}

TEST(SpeedLead, ADriveThatIsTwiceAsSlowOvershootsHalfAsMuch) {
  EXPECT_NEAR(overshoot(kResponse, 0.5), overshoot(0, 0.5) / 2, 0.01);
}

TEST(SpeedLead, ADriveThatIsFasterDoesNotOvershoot) {
  EXPECT_LT(overshoot(kResponse, 1.5), 2 * kPeriods);
}

TEST(SpeedLead, OrdersThePlanWithoutATime) {
  EXPECT_TRUE(std::signbit(SpeedLead(0, kLeadPeriod).step(-0.0, 10, 1)));
}

TEST(SpeedLead, IsExactlyZeroInTimeAfterTheRamp) {
  SpeedLead lead(kResponse, kLeadPeriod);
  for (int i = 0; i < 500; ++i) lead.step(0, kRamp, 1);
  double last = 1;
  for (int i = 0; i < 2000; ++i) last = lead.step(0, 0, 1);
  EXPECT_EQ(last, 0);
}

TEST(SpeedLead, SkippedCyclesCount) {
  SpeedLead every(kResponse, kLeadPeriod), third(kResponse, kLeadPeriod);
  double last = 0;
  for (int i = 0; i < 3; ++i) last = every.step(0, kRamp, 1);
  EXPECT_NEAR(third.step(0, kRamp, 3), last, 1.0e-12);
}

}  // namespace robot_control::tests
