#include "control/wheeled/wheel_loops/ground_friction.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "control/wheeled/test_robot.h"

namespace robot_control::tests {

constexpr double kCycle = 1e-3;  // s

struct GroundFrictionTest : testing::Test {
  GroundFriction law_{make_skid_steer()};
  std::array<double, 4> integral_{};

  void turn(double angular, int cycles = 1000, double linear = 0) {
    for (int i = 0; i < cycles; ++i) law_.move({linear, angular}, kCycle);
  }

  /// Learns for one cycle, as the controller does.
  double learn() {
    const double more = law_.learn([&](std::size_t wheel) { return integral_[wheel]; });
    for (std::size_t i = 0; i < integral_.size(); ++i) integral_[i] -= more * law_.strain(i);
    return more;
  }

  void hold(double part_of_strain) {
    for (std::size_t i = 0; i < integral_.size(); ++i) integral_[i] = part_of_strain * law_.strain(i);
  }
};

// The rolling direction takes 0.16/√(0.16² + 0.2²) of 59 N a wheel: 3.7 N·m at friction 1.
TEST_F(GroundFrictionTest, TurnsTreadsThatScrub) {
  for (const double direction : {1.0, -1.0}) {
    turn(direction);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(law_.effort(i), direction * kInitialGroundFriction * 3.677, 0.02);
  }
}

TEST_F(GroundFrictionTest, IsNoneOfOneWheelASide) {
  EXPECT_FALSE(GroundFriction(make_test_robot()).scrubs());
  EXPECT_TRUE(law_.scrubs());
}

TEST_F(GroundFrictionTest, FindsTheFrictionInTheIntegratorsAndLeavesTheTorqueAsItIs) {
  turn(1);
  hold(0.5);
  const double torque = integral_[2] + law_.effort(2);
  for (int i = 0; i < 200; ++i) {
    turn(1, 1);
    learn();
    EXPECT_NEAR(integral_[2] + law_.effort(2), torque, 1e-3 * torque);
  }
  EXPECT_NEAR(law_.friction(), kInitialGroundFriction + 0.5, 0.001);
  turn(-1);
  EXPECT_NEAR(law_.effort(2), -torque, 0.01 * torque) << "it follows the turn";
  law_.reset();
  EXPECT_EQ(law_.friction(), kInitialGroundFriction);
}

// 0.2 s at 2 1/s.
TEST_F(GroundFrictionTest, RisesUntilTheRobotTurnsAndThenSearchesNoMore) {
  turn(1);
  for (int i = 0; i < 200; ++i) law_.search({.part = 0.5, .effort = 2}, kCycle);
  EXPECT_NEAR(law_.friction(), kInitialGroundFriction + 0.4, 1e-9);
  const auto needed = static_cast<int>(GroundFriction::kLearningWay / (0.2 * kCycle)) + 1;  // 0.25 m·rad/s and more
  for (int i = 0; i < needed; ++i) law_.search({.part = 1, .effort = 2}, kCycle);
  EXPECT_NEAR(law_.friction(), kInitialGroundFriction + 0.4, 1e-9);
  EXPECT_FALSE(law_.searches());
  law_.reset();
  EXPECT_TRUE(law_.searches());
}

// Treads take 0.5 while torque rises by 10 a second; the excess accelerates a turn of inertia 0.05 s.
TEST_F(GroundFrictionTest, GivesBackWhatTheTorqueRoseByUntilTheRobotWasSeenToTurn) {
  turn(1);
  constexpr double kTaken = 0.5, kRise = 10, kIntegral = 0.1;
  double effort = kTaken, momentum = 0;
  for (int i = 0; i < 100; ++i) {
    effort += kRise * kCycle;
    momentum += (effort - kTaken) * kCycle;
    law_.search({.part = momentum / 0.05, .integral = kIntegral, .effort = effort, .momentum = momentum}, kCycle);
  }
  EXPECT_GT(effort, 1.4);
  EXPECT_NEAR(law_.friction(), kTaken - kIntegral, 0.01);
}

TEST_F(GroundFrictionTest, SearchesNoMoreThanDryConcreteAndNotWithoutATurn) {
  law_.search({}, 1);
  EXPECT_EQ(law_.friction(), kInitialGroundFriction);
  turn(1);
  law_.search({}, 10);
  EXPECT_EQ(law_.friction(), GroundFriction::kMaxSearched);
}

TEST_F(GroundFrictionTest, LeavesASlopeToTheIntegrators) {
  turn(1);
  const DriveTrain robot = make_skid_steer();
  for (std::size_t i = 0; i < 4; ++i) integral_[i] = robot.wheels[i].sign * 2.0;
  EXPECT_NEAR(learn(), 0, 1e-12);
}

TEST_F(GroundFrictionTest, LearnsNothingNearStraightOrWhereTreadsRest) {
  turn(0.02, 1000, 1.0);
  hold(10);
  EXPECT_EQ(learn(), 0);
  turn(1);
  turn(0, 1);
  hold(10);
  EXPECT_EQ(learn(), 0);
}

TEST_F(GroundFrictionTest, StaysWithinFrictionsThatThereAre) {
  for (const double direction : {1.0, -1.0}) {
    for (int i = 0; i < 2000; ++i) {
      turn(1, 1);
      hold(direction * 10);
      learn();
    }
    EXPECT_EQ(law_.friction(), direction > 0 ? kMaxGroundFriction : 0);
  }
}

// At the edge of sliding a robot with weak loops would creep.
TEST_F(GroundFrictionTest, LetsGoWhereThePlanStands) {
  turn(1);
  const double torque = law_.effort(0);
  turn(0, 1);
  EXPECT_NEAR(law_.effort(0), torque, 0.003 * torque) << "treads stay strained where they stop";
  turn(0, static_cast<int>(GroundFriction::kReleaseTime / kCycle));
  EXPECT_NEAR(law_.effort(0), torque * std::exp(-1), 0.01 * torque);
}

TEST_F(GroundFrictionTest, TakesWhatStandingWheelsHoldAgainstATurnForStrain) {
  turn(1);
  std::array<double, 4> held{};
  for (std::size_t i = 0; i < 4; ++i) held[i] = -0.5 * law_.effort(i);
  const double torque = law_.effort(1);
  law_.rest([&](std::size_t wheel) { return held[wheel]; });
  EXPECT_NEAR(law_.effort(1), -0.5 * torque, 0.01 * torque);
  for (double& effort : held) effort *= 100;
  law_.rest([&](std::size_t wheel) { return held[wheel]; });
  EXPECT_NEAR(law_.effort(1), -torque, 0.01 * torque) << "no more than scrub can be";
  const DriveTrain robot = make_skid_steer();
  for (std::size_t i = 0; i < 4; ++i) held[i] = robot.wheels[i].sign * 2.0;
  law_.rest([&](std::size_t wheel) { return held[wheel]; });
  EXPECT_NEAR(law_.effort(1), 0, 1e-12) << "a slope";
}

}  // namespace robot_control::tests
