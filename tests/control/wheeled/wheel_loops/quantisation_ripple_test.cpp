#include "control/wheeled/wheel_loops/quantisation_ripple.h"

#include <gtest/gtest.h>

#include "support/constants.h"

namespace robot_control::tests {

constexpr double kRippleInertia = 0.005;  // kg·m²
constexpr double kRippleLimit = 3.5;      // N·m
constexpr WheelLoopGains kRippleGains;

double ripple_at(double bandwidth, double speed, const WheelLoopGains& gains = kRippleGains) {
  return quantisation_ripple(gains, {.inertia = kRippleInertia, .damping = 0}, bandwidth, kRippleLimit, speed, kPeriod);
}

TEST(QuantisationRipple, IsSmallWithDerivedGainsAtAnySpeed) {
  for (const double speed : {10.0, 3.0, 1.0, 0.3}) EXPECT_LT(ripple_at(20, speed), 0.04 * kRippleLimit) << speed;
}

// The reference is the simulated diffbot: 0.27 … 0.34 of its limit at 80 Hz, and 0.31 … 0.40 at 95 Hz.
TEST(QuantisationRipple, IsThatOfTheSimulatedRobotWithAFastTrackingLoop) {
  for (const double speed : {10.0, 3.0, 1.0, 0.3}) {
    EXPECT_GT(ripple_at(80, speed), 0.25 * kRippleLimit) << speed;
    EXPECT_LT(ripple_at(80, speed), 0.5 * kRippleLimit) << speed;
  }
}

TEST(QuantisationRipple, EndsWithALoopOfAQuarterOfTheGains) {
  WheelLoopGains slow = kRippleGains;
  slow.kp /= 4;
  slow.ki /= 16;
  EXPECT_LT(ripple_at(80, 3, slow), 0.5 * ripple_at(80, 3));
}

// The damping is far faster than the period: the speed is τ/d, and nothing overflows.
TEST(QuantisationRipple, IsFiniteInAJointOfStiffDamping) {
  const double ripple =
      quantisation_ripple(kRippleGains, {.inertia = 1e-6, .damping = 0.1}, 20, kRippleLimit, 10, kPeriod);
  EXPECT_LT(ripple, kRippleLimit);
}

}  // namespace robot_control::tests
