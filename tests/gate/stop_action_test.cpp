/// The stop of one joint.

#include "gate/stop_action.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace robot_control::tests {

constexpr StopAction kMoving{
    .kind = StopKind::kMove, .damping = 2, .stiffness = 60, .target = 1.5, .time = 1.25, .brake_after = 1.5};
constexpr double kCycle = 0.001;  // s
constexpr double kBegin = 0.5;    // rad

/// The order after `time` s in which the joint, from `position` on, is where it was ordered.
JointCommand followed(JointStop& stop, double time, double position = kBegin) {
  JointCommand order;
  for (double t = 0; t < time; t += kCycle) {
    order = stop.step(kMoving, position, kCycle);
    if (order.mode == JointMode::kImpedance) position = order.position;
  }
  return order;
}

TEST(JointStop, MovesQuicklyAtFirstAndGentlyAtTheEnd) {
  JointStop stop;
  const JointCommand first = stop.step(kMoving, kBegin, kCycle);
  EXPECT_EQ(first.mode, JointMode::kImpedance);
  EXPECT_NEAR(first.velocity, 1 / 0.8, 1e-9);
  EXPECT_NEAR(first.position, kBegin + kCycle / 0.8, 1e-9);
  EXPECT_EQ(first.stiffness, 60);
  EXPECT_EQ(first.damping, 2);
  JointCommand last = first;
  for (double t = 2 * kCycle; t < 0.99; t += kCycle) {
    const JointCommand next = stop.step(kMoving, last.position, kCycle);
    EXPECT_GE(next.position, last.position);
    EXPECT_LE(next.velocity, last.velocity);
    EXPECT_EQ(next.stiffness, 60);
    last = next;
  }
  EXPECT_NEAR(last.velocity, (kMoving.target - last.position) / 0.225, 0.01);
  EXPECT_LT(kMoving.target - last.position, 0.1);
}

TEST(JointStop, DampsAloneAfterItsStiffnessFaded) {
  JointStop stop;
  EXPECT_NEAR(followed(stop, 1.2).stiffness, 60 * 0.05 / 0.25, 1);
  const JointCommand last = followed(stop, 0.1, kMoving.target);
  EXPECT_EQ(last.mode, JointMode::kVelocity);
  EXPECT_EQ(last.velocity, 0);
  EXPECT_EQ(last.damping, 2);
}

// The foot was in the air: it meets the ground when the others come as low.
TEST(JointStop, OfAJointThatIsAheadWaitsForTheOthers) {
  StopAction action = kMoving;
  action.start = 0.3;
  JointStop ahead, usual;
  JointCommand waits{.position = 0.9}, other{.position = 0.3};
  for (double t = 0; t < 1.2; t += kCycle) {
    waits = ahead.step(action, waits.position, kCycle);
    other = usual.step(action, other.position, kCycle);
    EXPECT_NEAR(waits.position, std::max(0.9, other.position), 1e-9);
    EXPECT_EQ(waits.velocity, other.position < 0.9 ? 0 : other.velocity);
  }
}

TEST(JointStop, OfAJointThatIsBehindOrBeyondBeginsAtOnce) {
  StopAction action = kMoving;
  action.start = kBegin;
  for (const double position : {0.2, 1.7}) {
    JointStop stop;
    EXPECT_NEAR(stop.step(action, position, kCycle).velocity, (kMoving.target - position) / 0.8, 1e-9);
  }
}

TEST(JointStop, MovesAgainFromWhereACommandLeftTheJoint) {
  JointStop stop;
  followed(stop, 2);
  stop = {};
  const JointCommand again = stop.step(kMoving, 1.0, kCycle), first = JointStop().step(kMoving, 1.0, kCycle);
  EXPECT_EQ(std::memcmp(&again, &first, sizeof first), 0);
}

TEST(JointStop, DampsAloneOnceItsTimeIsOverAndEndsAsTheBrakeOfTheDriver) {
  JointStop stop;
  const double lying = kMoving.target;
  EXPECT_EQ(stop.step(kMoving, lying, kMoving.time).mode, JointMode::kVelocity);
  EXPECT_EQ(stop.step(kMoving, lying, 0.19 * kMoving.time).mode, JointMode::kVelocity);
  EXPECT_EQ(stop.step(kMoving, lying, 0.02 * kMoving.time).mode, JointMode::kBrake);
}

// Its encoder or its motor has failed: what moves and what damps would drive it on.
TEST(JointStop, OfAJointThatIsFarFromItsOrderIsTheBrakeOfTheDriverFromThereOn) {
  for (const double time : {0.4, 1.3}) {
    JointStop stop;
    const JointCommand order = followed(stop, time);
    const double at = order.mode == JointMode::kImpedance ? order.position : kMoving.target;
    EXPECT_NE(stop.step(kMoving, at - 0.2, kCycle).mode, JointMode::kBrake);
    EXPECT_EQ(stop.step(kMoving, at - 0.3, kCycle).mode, JointMode::kBrake);
    EXPECT_EQ(stop.step(kMoving, at, kCycle).mode, JointMode::kBrake);
    stop = {};
    EXPECT_EQ(stop.step(kMoving, kBegin, kCycle).mode, JointMode::kImpedance);
  }
}

TEST(JointStop, WithoutATimeIsTheBrakeOfTheDriver) {
  EXPECT_EQ(JointStop().step({.kind = StopKind::kMove}, kBegin, kCycle).mode, JointMode::kBrake);
}

TEST(JointStop, DampsAJointWithoutAPosition) {
  JointStop stop;
  EXPECT_EQ(stop.step(kMoving, std::nullopt, kCycle).mode, JointMode::kVelocity);
}

TEST(JointStop, DoesNotPassTheTargetAfterALongGap) {
  JointStop stop;
  stop.step(kMoving, kBegin, kCycle);
  const JointCommand late = stop.step(kMoving, kMoving.target, 1.0);
  EXPECT_EQ(late.mode, JointMode::kImpedance);
  EXPECT_LE(late.position, kMoving.target);
}

}  // namespace robot_control::tests
