#include "estimation/wheeled/wheels/arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace robot_control::tests {

// Bound for the rounding of a few operations on numbers of order 1.
constexpr double kArcRounding = 1e-15;

TEST(Arc, QuarterCircleEndsOneRadiusAheadAndOneRadiusLeft) {
  const double radius = 2.0;
  const double turn = std::numbers::pi / 2;
  const Planar chord = chord_of({radius * turn, 0, turn}, 0);
  EXPECT_NEAR(chord.x, radius, 4 * kArcRounding);
  EXPECT_NEAR(chord.y, radius, 4 * kArcRounding);
}

TEST(Arc, FullCircleReturns) {
  const Planar chord = chord_of({3.0, 0, 2 * std::numbers::pi}, 0.7);
  EXPECT_NEAR(chord.x, 0, kArcRounding);
  EXPECT_NEAR(chord.y, 0, kArcRounding);
}

TEST(Arc, ZeroTurnIsTheStraightLine) {
  const Planar chord = chord_of({2.0, 0, 0}, std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(chord.x, 2 * std::cos(std::numbers::pi / 6));
  EXPECT_DOUBLE_EQ(chord.y, 2 * std::sin(std::numbers::pi / 6));
}

TEST(Arc, ReverseIsTheMirrorOfForward) {
  const Planar forward = chord_of({1.0, 0, 0.4}, 0);
  const Planar back = chord_of({-1.0, 0, -0.4}, 0.4);
  EXPECT_NEAR(forward.x + back.x, 0, kArcRounding);
  EXPECT_NEAR(forward.y + back.y, 0, kArcRounding);
}

// The midpoint rule with n steps has an error that falls with n²; 20000 steps of a 1 rad turn give less than 1e-9.
TEST(Arc, EqualsFineIntegrationOfItsTwist) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int sample = 0; sample < 20; ++sample) {
    const Motion motion{any(random), any(random), any(random)};
    const double yaw = 3 * any(random);
    const int steps = 20000;
    double x = 0;
    double y = 0;
    for (int i = 0; i < steps; ++i) {
      const double here = yaw + motion.turn * (i + 0.5) / steps;
      x += (motion.forward * std::cos(here) - motion.left * std::sin(here)) / steps;
      y += (motion.forward * std::sin(here) + motion.left * std::cos(here)) / steps;
    }
    const Planar chord = chord_of(motion, yaw);
    EXPECT_NEAR(chord.x, x, 1e-9) << "sample " << sample;
    EXPECT_NEAR(chord.y, y, 1e-9) << "sample " << sample;
  }
}

// Its series 1 − h²/6 + h⁴/120 is exact to rounding there.
TEST(Sinc, IsItsSeriesNearZero) {
  for (const double h : {1e-300, 1e-8, -1e-4, 1e-3}) {
    EXPECT_NEAR(sinc(h), 1 - h * h / 6 * (1 - h * h / 20), kArcRounding) << h;
  }
}

TEST(Sinc, IsOneAtZero) {
  EXPECT_EQ(sinc(0), 1);
}

}  // namespace robot_control::tests
