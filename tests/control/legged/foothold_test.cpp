#include "control/legged/foothold.h"

#include <gtest/gtest.h>

#include <cmath>

namespace robot_control {
namespace {

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
  const Eigen::Vector2d before = foothold(input);
  input.measured += Eigen::Vector2d(0.1, 0);
  EXPECT_NEAR((foothold(input) - before).x(), 0.1 * (input.stance_time / 2 + kReturn), kRounding);
}

TEST(Foothold, TurningOnTheSpotTurnsTheNominalPlace) {
  FootholdInput input = walking();
  input.requested = input.measured = Eigen::Vector2d::Zero();
  input.yaw_rate = 1.5;
  const double angle = input.yaw_rate * (input.until_landing + input.stance_time / 2);
  EXPECT_LT((foothold(input) - Eigen::Rotation2Dd(angle) * input.nominal).norm(), kRounding);
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
  EXPECT_NEAR(beyond.x(), kAhead * input.leg_length, kRounding);
  EXPECT_NEAR(beyond.y(), -kAside * input.leg_length, kRounding);
}

}  // namespace
}  // namespace robot_control
