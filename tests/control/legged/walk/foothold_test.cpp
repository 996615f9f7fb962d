#include "control/legged/walk/foothold.h"

#include <gtest/gtest.h>

#include <cmath>

namespace robot_control::tests {

constexpr double kRounding = 1e-12;

FootholdInput walking() {
  FootholdInput input;
  input.nominal << 0.2, 0.1;
  input.requested << 0.5, 0.1;
  input.measured = input.requested;
  input.until_landing = 0.1;
  input.stance_time = 0.2;
  input.height = 0.3;
  return input;
}

TEST(Foothold, AStandingRobotPutsItsFootOnTheNominalPlace) {
  FootholdInput input = walking();
  input.requested = input.measured = Eigen::Vector2d::Zero();
  EXPECT_LT((foothold(input) - input.nominal).norm(), kRounding);
}

TEST(Foothold, TheHipIsAboveTheFootInTheMiddleOfTheStance) {
  const FootholdInput input = walking();
  const Eigen::Vector2d moved = (input.until_landing + input.stance_time / 2) * input.measured;
  EXPECT_LT((foothold(input) - input.nominal - moved).norm(), kRounding);
}

TEST(Foothold, ABodyThatIsTooFastPutsItsFootFartherAhead) {
  FootholdInput input = walking();
  for (const double legs : {1.0, 4.0}) {
    input.leg_length = legs * 0.426;
    input.height = legs * 0.3;
    input.measured = input.requested;
    const Eigen::Vector2d before = foothold(input);
    input.measured += Eigen::Vector2d(0.1, 0);
    EXPECT_NEAR((foothold(input) - before).x(), 0.1 * (0.1 + 0.05 * std::sqrt(legs)), kRounding);
  }
}

TEST(Foothold, ALongStanceDoesNotPutItBeyondThePlaceThatCatchesTheBody) {
  FootholdInput input = walking();
  input.stance_time = 0.8;
  const Eigen::Vector2d before = foothold(input);
  input.measured += Eigen::Vector2d(0.1, 0);
  EXPECT_NEAR((foothold(input) - before).x(), 0.1 * std::sqrt(input.height / kGravity), kRounding);
}

TEST(Foothold, TurningOnTheSpotTurnsTheNominalPlace) {
  FootholdInput input = walking();
  input.requested = input.measured = Eigen::Vector2d::Zero();
  input.yaw_rate = 1.5;
  const double angle = input.yaw_rate * (input.until_landing + input.stance_time / 2);
  EXPECT_LT((foothold(input) - Eigen::Rotation2Dd(angle) * input.nominal).norm(), kRounding);
}

// In each of the two times the body moves along a chord of its circle, which is shorter by (ω t/2)²/6 at most.
TEST(Foothold, TheHipIsAboveTheFootInTheMiddleOfTheStanceOnACircleToo) {
  FootholdInput input = walking();
  input.height = 0;
  input.yaw_rate = 0.5;
  constexpr int kParts = 1000;
  const double time = input.until_landing + input.stance_time / 2;
  Eigen::Vector2d hip = Eigen::Rotation2Dd(input.yaw_rate * time) * input.nominal;
  for (int i = 0; i < kParts; ++i) {
    const double angle = input.yaw_rate * time * (i + 0.5) / kParts;
    hip += time / kParts * (Eigen::Rotation2Dd(angle) * input.requested);
  }
  EXPECT_LT((foothold(input) - hip).norm(), 1.1e-4 * time * input.requested.norm());
}

TEST(Foothold, ATurningRobotLeansTheForcesInwards) {
  FootholdInput input = walking();
  input.requested = input.measured = Eigen::Vector2d(0.5, 0);
  input.until_landing = input.stance_time = 0;
  input.yaw_rate = 0.5;
  // The force m [a, g] passes through the centre of gravity, h above the ground, if the foot is a h/g outside.
  const double outside = input.yaw_rate * 0.5 * input.height / kGravity;
  EXPECT_LT((foothold(input) - input.nominal - Eigen::Vector2d(0, -outside)).norm(), kRounding);
}

TEST(Foothold, StaysWithinReachOfTheLeg) {
  FootholdInput input = walking();
  input.measured << 100, -100;
  const Eigen::Vector2d beyond = foothold(input) - input.nominal;
  EXPECT_NEAR(beyond.x(), 0.66 * input.leg_length, kRounding);
  EXPECT_NEAR(beyond.y(), -0.47 * input.leg_length, kRounding);
}

}  // namespace robot_control::tests
