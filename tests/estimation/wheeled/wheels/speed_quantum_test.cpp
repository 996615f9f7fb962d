// Wheel speeds in steps, at any rate and with any stamps, and speeds without steps.

#include "estimation/wheeled/wheels/speed_quantum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace robot_control::tests {

struct SpeedReadings : testing::Test {
  /// A changing speed, read every `gap` s or so, and rounded to `step` m/s.
  SpeedQuantum read(double step, double gap, double count = 1e-4) {
    SpeedQuantum quantum(count);
    for (int i = 1; i < 400; ++i) {
      const double time = gap * (1 + 0.02 * normal_(random_));
      const double speed = 0.5 + 0.4 * std::sin(0.3 * i * gap) + 0.01 * normal_(random_);
      quantum.add((step > 0 ? step * std::round(speed / step) : speed) * time, time);
    }
    return quantum;
  }
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
};

class SpeedSteps : public SpeedReadings, public testing::WithParamInterface<std::pair<double, double>> {};

TEST_P(SpeedSteps, AreFound) {
  const auto [step, gap] = GetParam();
  EXPECT_NEAR(read(step, gap).step(), step, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Rates, SpeedSteps,
                         testing::Values(std::pair{0.08, 0.154}, std::pair{0.02, 0.1}, std::pair{0.05, 0.02},
                                         std::pair{0.2, 0.2}));

TEST_F(SpeedReadings, ASmoothSpeedHasNone) {
  EXPECT_LT(read(0, 0.1).step(), 0.005);
}

TEST_F(SpeedReadings, StepsThatTheEncodersCountExplainsAreNone) {
  EXPECT_EQ(read(0.08, 0.02, 0.001).step(), 0);
}

}  // namespace robot_control::tests
