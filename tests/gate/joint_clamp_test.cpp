#include "gate/joint_clamp.h"

#include <gtest/gtest.h>

#include <cstring>

#include "signals/gate_report.h"

namespace robot_control::tests {

constexpr double kClampRounding = 1e-14;  // of numbers of order ten

/// 4 N·m, 20 rad/s, −1 … 3 rad with 0.5 rad before either end stop.
constexpr JointLimits kJoint{.effort = 4, .velocity = 20, .lower = -1, .upper = 3, .soft_zone = 0.5};
constexpr JointLimits kWheel{.effort = 4, .velocity = 20};

bool same(const JointCommand& one, const JointCommand& other) {
  return std::memcmp(&one, &other, sizeof one) == 0;
}

// The speed limit. Both directions: what holds of one holds of the other with every sign turned.

struct SpeedClamp : testing::TestWithParam<double> {
  JointCommand effort(double value) const { return {.mode = JointMode::kEffort, .effort = sign * value}; }
  double sign = GetParam();
};

TEST_P(SpeedClamp, LeavesEverythingAloneBelowTheTaper) {
  JointCommand command = effort(4);
  EXPECT_EQ(clamp_speed(kWheel, 0, sign * 17.9, command), 0u);
  EXPECT_TRUE(same(command, effort(4)));
}

// 18 of 20 rad/s.
TEST_P(SpeedClamp, LeavesEverythingAloneAtTheStartOfTheTaper) {
  JointCommand command{.mode = JointMode::kImpedance, .position = sign, .stiffness = 8, .effort = sign * 4};
  const JointCommand before = command;
  EXPECT_EQ(clamp_speed(kWheel, 0, sign * 18, command), 0u);
  EXPECT_TRUE(same(command, before));
}

TEST_P(SpeedClamp, LeavesTheSpeedLimitItselfAlone) {
  JointCommand command{.mode = JointMode::kVelocity, .velocity = sign * 20, .damping = 1};
  EXPECT_EQ(clamp_speed(kWheel, 0, 0, command), 0u);
  EXPECT_EQ(command.velocity, sign * 20);
}

TEST_P(SpeedClamp, TapersTheEffortTowardsMoreSpeed) {
  for (const auto& [speed, left] : {std::pair{18.5, 3.0}, {19.0, 2.0}, {19.5, 1.0}}) {
    JointCommand command = effort(4);
    EXPECT_EQ(clamp_speed(kWheel, 0, sign * speed, command), std::uint64_t{kGateSpeedClamped});
    // The differences of 1 − x are ten times as coarse.
    EXPECT_NEAR(command.effort, sign * left, 10 * kClampRounding) << speed;
  }
}

TEST_P(SpeedClamp, LeavesAloneWhatTheTaperAllows) {
  JointCommand command = effort(1.9);
  EXPECT_EQ(clamp_speed(kWheel, 0, sign * 19, command), 0u);
  EXPECT_EQ(command.effort, sign * 1.9);
}

TEST_P(SpeedClamp, RefusesEveryEffortTowardsMoreAtTheLimitAndBeyond) {
  for (const double speed : {20.0, 20.1, 1e300, std::numeric_limits<double>::infinity()}) {
    JointCommand command = effort(0.001);
    EXPECT_EQ(clamp_speed(kWheel, 0, sign * speed, command), std::uint64_t{kGateSpeedClamped}) << speed;
    EXPECT_EQ(command.effort, 0) << speed;
  }
}

TEST_P(SpeedClamp, EffortAgainstTheMotionIsFree) {
  JointCommand command = effort(-4);
  EXPECT_EQ(clamp_speed(kWheel, 0, sign * 1000, command), 0u);
  EXPECT_EQ(command.effort, -sign * 4);
}

TEST_P(SpeedClamp, BoundsTheSpeedThatIsAskedFor) {
  for (const JointMode mode : {JointMode::kVelocity, JointMode::kImpedance}) {
    JointCommand command{.mode = mode, .velocity = sign * 25, .damping = 1};
    EXPECT_EQ(clamp_speed(kWheel, 0, 0, command), std::uint64_t{kGateSpeedClamped});
    EXPECT_EQ(command.velocity, sign * 20);
  }
}

TEST_P(SpeedClamp, InEffortModeTheVelocityIsForDisplay) {
  JointCommand command{.mode = JointMode::kEffort, .velocity = sign * 25};
  EXPECT_EQ(clamp_speed(kWheel, 0, 0, command), 0u);
  EXPECT_EQ(command.velocity, sign * 25);
}

TEST_P(SpeedClamp, ASpringThatPullsOnIsSlackedOneThatPullsBackIsNot) {
  JointCommand command{.mode = JointMode::kImpedance, .position = sign * 2, .stiffness = 8};
  EXPECT_EQ(clamp_speed(kWheel, sign * 1, sign * 19, command), std::uint64_t{kGateSpeedClamped});
  EXPECT_NEAR(command.stiffness, 4, 10 * kClampRounding);
  command.stiffness = 8;
  EXPECT_EQ(clamp_speed(kWheel, sign * 2, sign * 19, command), 0u) << "it pulls nowhere";
  EXPECT_EQ(clamp_speed(kWheel, sign * 3, sign * 19, command), 0u);
  EXPECT_EQ(command.stiffness, 8);
}

TEST_P(SpeedClamp, WithoutALimitThereIsNone) {
  JointCommand command{.mode = JointMode::kVelocity, .velocity = sign * 1e9, .damping = 1, .effort = sign * 4};
  const JointCommand before = command;
  EXPECT_EQ(clamp_speed({.effort = 4}, 0, sign * 1e9, command), 0u);
  EXPECT_TRUE(same(command, before));
}

INSTANTIATE_TEST_SUITE_P(BothDirections, SpeedClamp, testing::Values(1.0, -1.0));

TEST(GainClamp, GainsBelowZeroAreZero) {
  JointCommand command{.mode = JointMode::kImpedance, .stiffness = -1, .damping = -2};
  EXPECT_EQ(clamp_gains(command), std::uint64_t{kGateSpeedClamped});
  EXPECT_EQ(command.stiffness, 0);
  EXPECT_EQ(command.damping, 0);
}

TEST(GainClamp, EitherGainBelowZeroIsReported) {
  JointCommand command{.mode = JointMode::kImpedance, .stiffness = 0.5, .damping = -2};
  EXPECT_EQ(clamp_gains(command), std::uint64_t{kGateSpeedClamped});
  EXPECT_EQ(command.stiffness, 0.5);
  command = {.mode = JointMode::kImpedance, .stiffness = -1, .damping = 0.5};
  EXPECT_EQ(clamp_gains(command), std::uint64_t{kGateSpeedClamped});
  EXPECT_EQ(command.damping, 0.5);
}

TEST(GainClamp, GainsOfZeroAreLeftAlone) {
  JointCommand command{.mode = JointMode::kImpedance};
  EXPECT_EQ(clamp_gains(command), 0u);
}

TEST(GainClamp, GainsThatTheModeDoesNotUseAreCarried) {
  JointCommand command{.mode = JointMode::kVelocity, .stiffness = -1, .damping = 2};
  EXPECT_EQ(clamp_gains(command), 0u);
  EXPECT_EQ(command.stiffness, -1);
}

// End stops: the upper one, and the lower one as its mirror image about 1 rad, the middle.

struct PositionClamp : testing::TestWithParam<double> {
  double at(double left) const { return sign > 0 ? kJoint.upper - left : kJoint.lower + left; }
  double sign = GetParam();
};

TEST_P(PositionClamp, LeavesEverythingAloneBeforeTheSoftZone) {
  JointCommand command{.mode = JointMode::kVelocity, .velocity = sign * 20, .damping = 1, .effort = sign * 4};
  const JointCommand before = command;
  EXPECT_EQ(clamp_position(kJoint, at(0.6), command), 0u);
  EXPECT_TRUE(same(command, before));
}

TEST_P(PositionClamp, TapersEffortAndVelocityTowardsTheEndStop) {
  JointCommand command{.mode = JointMode::kVelocity, .velocity = sign * 20, .damping = 1, .effort = sign * 4};
  EXPECT_EQ(clamp_position(kJoint, at(0.125), command), std::uint64_t{kGatePositionClamped});
  EXPECT_EQ(command.effort, sign * 1);
  EXPECT_EQ(command.velocity, sign * 5);
}

TEST_P(PositionClamp, WithoutASpeedLimitTheVelocityItselfTapers) {
  JointLimits limits = kJoint;
  limits.velocity = std::numeric_limits<double>::infinity();
  JointCommand command{.mode = JointMode::kVelocity, .velocity = sign * 8, .damping = 1};
  EXPECT_EQ(clamp_position(limits, at(0.125), command), std::uint64_t{kGatePositionClamped});
  EXPECT_EQ(command.velocity, sign * 2);
}

TEST_P(PositionClamp, AwayFromTheEndStopEverythingIsFree) {
  for (const double left : {0.1, 0.0, -0.3}) {
    JointCommand command{.mode = JointMode::kVelocity, .velocity = -sign * 20, .damping = 1, .effort = -sign * 4};
    const JointCommand before = command;
    EXPECT_EQ(clamp_position(kJoint, at(left), command), 0u) << left;
    EXPECT_TRUE(same(command, before)) << left;
  }
}

TEST_P(PositionClamp, AtTheEndStopSpeedOrEffortAwayFromItIsFree) {
  JointCommand speed{.mode = JointMode::kVelocity, .velocity = -sign, .damping = 1};
  JointCommand effort{.mode = JointMode::kVelocity, .damping = 1, .effort = -sign};
  for (JointCommand* command : {&speed, &effort}) {
    const JointCommand before = *command;
    EXPECT_EQ(clamp_position(kJoint, at(0), *command), 0u);
    EXPECT_TRUE(same(*command, before));
  }
}

TEST_P(PositionClamp, AtTheEndStopAndBeyondACommandTowardsItIsTheBrake) {
  const JointCommand towards[] = {{.mode = JointMode::kEffort, .effort = sign * 0.01},
                                  {.mode = JointMode::kVelocity, .velocity = sign * 0.01, .damping = 1},
                                  {.mode = JointMode::kImpedance, .position = 1, .effort = sign * 0.01}};
  for (const double left : {0.0, -0.01, -1e9}) {
    for (JointCommand command : towards) {
      EXPECT_EQ(clamp_position(kJoint, at(left), command), std::uint64_t{kGatePositionClamped});
      EXPECT_TRUE(same(command, JointCommand{}));
    }
  }
}

TEST_P(PositionClamp, APositionBehindTheEndStopIsTheEndStop) {
  JointCommand command{.mode = JointMode::kImpedance, .position = sign * 50, .stiffness = 3};
  EXPECT_EQ(clamp_position(kJoint, at(2), command), std::uint64_t{kGatePositionClamped});
  EXPECT_EQ(command.position, at(0));
  EXPECT_EQ(command.stiffness, 3);
}

TEST_P(PositionClamp, WithoutASoftZoneTheEndStopAloneCounts) {
  JointLimits limits{.effort = 4, .velocity = 20, .lower = kJoint.lower, .upper = kJoint.upper};
  JointCommand command{.mode = JointMode::kEffort, .effort = sign * 4};
  EXPECT_EQ(clamp_position(limits, at(1e-9), command), 0u);
  EXPECT_EQ(command.effort, sign * 4);
  limits.velocity = std::numeric_limits<double>::infinity();
  JointCommand still{.mode = JointMode::kVelocity, .damping = 1};
  for (const double left : {1.0, 0.0}) EXPECT_EQ(clamp_position(limits, at(left), still), 0u) << left;
  EXPECT_EQ(still.velocity, 0);
  EXPECT_EQ(clamp_position(limits, at(0), command), std::uint64_t{kGatePositionClamped});
  EXPECT_EQ(command.mode, JointMode::kBrake);
}

TEST_P(PositionClamp, AWheelHasNoEnd) {
  JointCommand command{.mode = JointMode::kImpedance, .position = sign * 1e9, .stiffness = 1, .effort = sign * 4};
  const JointCommand before = command;
  EXPECT_EQ(clamp_position(kWheel, sign * 1e9, command), 0u);
  EXPECT_TRUE(same(command, before));
}

INSTANTIATE_TEST_SUITE_P(BothEnds, PositionClamp, testing::Values(1.0, -1.0));

TEST(AccelerationClamp, BringsTheVelocityOfADrivesOwnLoopToTheNearerEnd) {
  JointCommand command{.mode = JointMode::kDriveVelocity, .velocity = 3};
  EXPECT_EQ(clamp_acceleration(-1, 2, command), std::uint64_t{kGateRateClamped});
  EXPECT_EQ(command.velocity, 2);
  EXPECT_EQ(clamp_acceleration(-1, 2, command), 0u);
  JointCommand torque{.mode = JointMode::kEffort, .velocity = 3};
  EXPECT_EQ(clamp_acceleration(-1, 2, torque), 0u);
}

TEST(SpeedClamp, BoundsTheVelocityOfADrivesOwnLoop) {
  JointCommand command{.mode = JointMode::kDriveVelocity, .velocity = -20};
  EXPECT_EQ(clamp_speed({.effort = 4, .velocity = 10}, 0, 0, command), std::uint64_t{kGateSpeedClamped});
  EXPECT_EQ(command.velocity, -10);
}

TEST(RateClamp, BringsTheEffortToTheNearerEnd) {
  JointCommand command{.mode = JointMode::kEffort, .effort = 3};
  EXPECT_EQ(clamp_rate(-1, 2, command), std::uint64_t{kGateRateClamped});
  EXPECT_EQ(command.effort, 2);
  command.effort = -1.5;
  EXPECT_EQ(clamp_rate(-1, 2, command), std::uint64_t{kGateRateClamped});
  EXPECT_EQ(command.effort, -1);
  EXPECT_EQ(clamp_rate(-1, 2, command), 0u);
  command.effort = 2;
  EXPECT_EQ(clamp_rate(-1, 2, command), 0u);
}

}  // namespace robot_control::tests
