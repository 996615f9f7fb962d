#include "control/legged/tracked_axis.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr double kPeriod = 0.001;  // s
constexpr std::array<AxisBounds, 2> kBounds{{{.speed = 0.4, .acceleration = 3}, {.speed = 0.9, .acceleration = 40}}};
using Axes = std::array<TrackedAxis, 2>;

/// Returns the parts of its acceleration that each axis has used between two cycles, together.
double used(const Axes& before, const Axes& now) {
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i)
    sum += std::abs(now[i].speed - before[i].speed) / kPeriod / kBounds[i].acceleration;
  return sum;
}

TEST(TrackedAxes, ReachTheirTargetOnAStraightWayWithinTheirBounds) {
  const std::array<double, 2> target{0.05, -0.3};
  Axes axes{};
  double fastest = 0;
  for (int k = 0; k < 1500; ++k) {
    const Axes before = axes;
    track(axes, target, kBounds, kPeriod);
    ASSERT_LE(used(before, axes), 1 + 1e-9) << k;
    for (std::size_t i = 0; i < 2; ++i) ASSERT_LE(std::abs(axes[i].speed), kBounds[i].speed + 1e-12) << k;
    ASSERT_NEAR(axes[0].value / target[0], axes[1].value / target[1], 1e-9) << k;
    ASSERT_LE(axes[0].value, target[0] + kBounds[0].speed * kPeriod) << k;
    fastest = std::max(fastest, -axes[1].speed);
  }
  EXPECT_NEAR(fastest, 0.9, 1e-9);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(axes[i].value, target[i], 1e-6);
}

TEST(TrackedAxes, FollowATargetThatMovesWithALag) {
  constexpr double kSlow = 0.04;
  Axes axes{};
  double target = 0;
  for (int k = 0; k < 2000; ++k) {
    target += kSlow * kPeriod;
    track(axes, {target, 0}, kBounds, kPeriod);
  }
  EXPECT_NEAR(target - axes[0].value, kSlow / TrackedAxis::kFollow, kSlow * kPeriod + 1e-9);
  EXPECT_EQ(axes[1].value, 0);
}

// From one cycle to the next an axis moves by no more than its distance.
TEST(TrackedAxes, ArriveAndRestInASlowLoop) {
  for (const double period : {0.01, 0.02, 0.05}) {
    Axes axes{};
    for (double time = 0; time < 3; time += period) track(axes, {0.05, -0.3}, kBounds, period);
    for (const TrackedAxis& axis : axes) EXPECT_NEAR(axis.speed, 0, 1e-9) << period;
    EXPECT_NEAR(axes[0].value, 0.05, 1e-9) << period;
    EXPECT_NEAR(axes[1].value, -0.3, 1e-9) << period;
  }
}

TEST(TrackedAxes, TurnAroundWithinTheirBounds) {
  Axes axes{};
  for (int k = 0; k < 3000; ++k) {
    const Axes before = axes;
    const double side = k / 150 % 2 == 0 ? 1 : -1;
    track(axes, {0.1 * side, k / 220 % 2 == 0 ? 0.3 : -0.3}, kBounds, kPeriod);
    ASSERT_LE(used(before, axes), 1 + 1e-9) << k;
  }
}

TEST(TrackedAxes, BrakeToTheStoppingPlace) {
  Axes axes{{{.value = 0.1, .speed = 0.3}, {.value = -0.2, .speed = -0.8}}};
  const std::array<double, 2> place = stopping_place(axes, kBounds);
  while (axes[0].speed > 0) {
    const Axes before = axes;
    brake(axes, kBounds, kPeriod);
    ASSERT_LE(used(before, axes), 1 + 1e-9);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(axes[i].speed, 0);
    EXPECT_NEAR(axes[i].value, place[i], 0.8 * kPeriod / 2 + 1e-9);
  }
  EXPECT_LE(axes[0].value, place[0]);  // never beyond
  EXPECT_GE(axes[1].value, place[1]);
}

}  // namespace robot_control::tests
