#include "control/common/limits/stop_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/wheeled/limits/speed_limiter.h"
#include "support/constants.h"

namespace robot_control::tests {

TEST(StopDistance, IsThatOfTextbooksWithoutAJerkLimit) {
  EXPECT_DOUBLE_EQ(stop_distance(1, 2, std::numeric_limits<double>::infinity()), 0.25);
}

TEST(StopDistance, BothFormsMeet) {
  const double v = 2 * 2 / 10.0;  // d²/j
  EXPECT_NEAR(stop_distance(v, 2, 10), stop_distance(std::nextafter(v, 0), 2, 10), 1e-12);
}

TEST(StopDistance, IsTheSameInReverse) {
  EXPECT_EQ(stop_distance(-0.7, 1, 10), stop_distance(0.7, 1, 10));
}

TEST(StopDistance, IsWhatTheLimiterTakes) {
  std::mt19937 random(1);
  const auto of_scale = [&random](double low, double high) {
    return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random));
  };
  for (int trial = 0; trial < 500; ++trial) {
    SpeedLimits limits;
    limits.linear = {.speed = 2,
                     .acceleration = of_scale(0.2, 10),
                     .deceleration = of_scale(0.2, 10),
                     .emergency_deceleration = 10,
                     .jerk = trial % 5 == 0 ? std::numeric_limits<double>::infinity() : of_scale(1, 200)};
    const bool emergency = trial % 2 == 0;
    const double speed = of_scale(0.02, 2);
    SpeedLimiter limiter(limits);
    limiter.restart_from({speed, 0});
    double distance = 0;
    for (double before = speed; before > 0; before = limiter.value().linear) {
      distance += 0.5 * (before + limiter.step({}, kPeriod, emergency).linear) * kPeriod;
    }
    const double deceleration = emergency ? 10 : limits.linear.deceleration;
    ASSERT_NEAR(distance, stop_distance(speed, deceleration, limits.linear.jerk), speed * kPeriod)
        << speed << " m/s, " << deceleration << " m/s², " << limits.linear.jerk << " m/s³, against "
        << limits.linear.acceleration;
  }
}

}  // namespace robot_control::tests
