/// The law of a braking drive, by the numbers of its header: τ = −d q̇ while it slows, k (q* − q) − d q̇ while it holds.

#include "gate/brake_law.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr Brake kFirm{.effort = 3, .hold_effort = 5, .damping = 2, .stiffness = 40, .hold_speed = 0.1};
constexpr double kTiny = 1e-12;  // rounding of numbers below 10

struct BrakeLawTest : testing::Test {
  /// Returns the cycle, from 1 on, in which it begins to hold at this speed, or 0 after `steps`.
  int holds_after(int steps, double speed) {
    for (int i = 1; i <= steps; ++i) {
      law_.step(0, 0, speed);
      if (law_.holding()) return i;
    }
    return 0;
  }
  /// Holds at the position 0.7 rad without a torque.
  void hold() { law_.step(0, 0.7, 0); }

  BrakeLaw law_{kFirm};
};

TEST_F(BrakeLawTest, SlowsByDampingUpToTheEffort) {
  EXPECT_EQ(law_.step(0, 0.7, 1), -2);
  EXPECT_EQ(law_.step(0, 0.7, -1), 2);
  EXPECT_EQ(law_.step(0, 0.7, 4), -3);
  EXPECT_EQ(law_.step(0, 0.7, -4), 3);
  EXPECT_FALSE(law_.holding());
}

TEST_F(BrakeLawTest, HoldsFromTheHoldSpeedOn) {
  law_.step(0, 0, 0.1001);
  EXPECT_FALSE(law_.holding());
  law_.step(0, 0, -0.1);
  EXPECT_TRUE(law_.holding());
}

TEST_F(BrakeLawTest, BeginsToHoldWithTheTorqueAppliedLast) {
  EXPECT_NEAR(law_.step(1.2, 0.7, 0.05), 1.2, kTiny);
  // q* − q = (1.2 + 2 · 0.05)/40 − 0.01, of which the spring makes 0.9 and the damping takes 2 · 0.02.
  EXPECT_NEAR(law_.step(1.2, 0.71, 0.02), 0.86, kTiny);
}

TEST_F(BrakeLawTest, BeginsToHoldWithTheHoldEffortAtMost) {
  EXPECT_NEAR(law_.step(9, 0.7, 0), 5, kTiny);
  law_.release();
  EXPECT_NEAR(law_.step(-9, 0.7, 0), -5, kTiny);
}

TEST_F(BrakeLawTest, ALoadBeyondTheBoundMovesItsReference) {
  hold();
  EXPECT_EQ(law_.step(0, 1.7, 0.3), -5);
  // q* = 1.7 + (−5 + 2 · 0.3)/40, so that 0.05 rad farther back the spring pulls with −4.4 + 40 · 0.05.
  EXPECT_NEAR(law_.step(0, 1.65, 0), -2.4, 1e-9);
  EXPECT_EQ(law_.step(0, -1, 0), 5);
}

TEST_F(BrakeLawTest, HoldsOnAtAnySpeed) {
  hold();
  EXPECT_NEAR(law_.step(0, 0.7, 1.9), -3.8, kTiny);
  EXPECT_TRUE(law_.holding());
}

// 2 · 0.5 N·m are below the bound of 3.
TEST_F(BrakeLawTest, HoldsWhereALoadKeepsTheSpeedFromFallingByATenthInFiftySteps) {
  EXPECT_EQ(holds_after(50, 0.5), 50);
}

TEST_F(BrakeLawTest, SlowsOnWhileTheSpeedFallsByATenthInFiftySteps) {
  EXPECT_EQ(holds_after(1, 1.0), 0);
  EXPECT_EQ(holds_after(49, 0.9), 0);
  EXPECT_EQ(holds_after(50, 0.8), 0);  // 0.8 < 0.9 · 0.9
  EXPECT_EQ(holds_after(50, 0.73), 50);
}

// 2 · 1.5 N·m are the bound.
TEST_F(BrakeLawTest, AtItsBoundHoldsOnlyWhereTheSpeedGrows) {
  EXPECT_EQ(holds_after(100, 1.5), 0);
  EXPECT_EQ(holds_after(50, 1.51), 50);
}

TEST_F(BrakeLawTest, ReleasedSlowsAgainAndCountsFromNothing) {
  hold();
  law_.release();
  EXPECT_FALSE(law_.holding());
  EXPECT_EQ(law_.step(0, 0.7, 1), -2);
  EXPECT_EQ(holds_after(10, 0.5), 0);
  law_.release();
  EXPECT_EQ(holds_after(50, 0.45), 50);
}

}  // namespace robot_control::tests
