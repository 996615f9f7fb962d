#include "control/wheel_loops/wheel_progress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace robot_control {
namespace {

constexpr double kSample = 1e-3;

/// Largest and last `held` of a wheel that turns at `part` of a plan of `planned` rad/s, in counts of `quantum` rad.
struct Held {
  double most = 0;
  double last = 0;
};
Held held(double planned, double part, double quantum) {
  WheelProgress progress;
  progress.restart_from(0);
  Held result;
  for (int k = 1; k <= 3000; ++k) {
    progress.step(planned, std::floor(part * planned * k * kSample / quantum) * quantum, quantum, kSample);
    if (k > 1500) result.most = std::max(result.most, std::abs(progress.held()));
    result.last = progress.held();
  }
  return result;
}

TEST(WheelProgress, OfAWheelThatStandsIsHeldTowardsItsPlan) {
  EXPECT_EQ(held(2, 0, 1.5e-3).last, 1);
  EXPECT_EQ(held(-2, 0, 1.5e-3).last, -1);
}

TEST(WheelProgress, OfAWheelThatTurnsTheOtherWayIsHeld) {
  EXPECT_EQ(held(2, -0.5, 1.5e-3).last, 1);
}

TEST(WheelProgress, OfAWheelThatFollowsIsNotHeldWhateverItsCountsAndSpeed) {
  for (const double counts : {45, 90, 512, 4096}) {
    for (const double planned : {0.1, 1.0, 10.0}) {
      const Held result = held(planned, 0.8, 2 * std::numbers::pi / counts);
      EXPECT_EQ(result.most, 0) << counts << " counts, " << planned << " rad/s";
    }
  }
}

TEST(WheelProgress, WithoutAPlanNothingIsHeld) {
  EXPECT_EQ(held(0, 0, 1.5e-3).last, 0);
}

}  // namespace
}  // namespace robot_control
