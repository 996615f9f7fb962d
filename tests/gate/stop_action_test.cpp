/// The stop of one joint.

#include "gate/stop_action.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace robot_control {
namespace {

constexpr StopAction kFolding{.kind = StopKind::kFold, .damping = 2, .stiffness = 60, .posture = 1.5, .time = 1.25};
constexpr double kCycle = 0.001;  // s
constexpr double kBegin = 0.5;    // rad

/// The order after `time` s in which the joint, from `position` on, is where it was ordered.
JointCommand followed(JointStop& stop, double time, double position = kBegin) {
  JointCommand order;
  for (double t = 0; t < time; t += kCycle) {
    order = stop.step(position, kCycle);
    if (order.mode == JointMode::kImpedance) position = order.position;
  }
  return order;
}

TEST(JointStop, FoldsQuicklyAtFirstAndGentlyAtTheEnd) {
  JointStop stop(kFolding);
  const JointCommand first = stop.step(kBegin, kCycle);
  EXPECT_EQ(first.mode, JointMode::kImpedance);
  EXPECT_NEAR(first.velocity, 1 / 0.8, 1e-9);
  EXPECT_NEAR(first.position, kBegin + kCycle / 0.8, 1e-9);
  EXPECT_EQ(first.stiffness, 60);
  EXPECT_EQ(first.damping, 2);
  JointCommand last = first;
  for (double t = 2 * kCycle; t < 0.99; t += kCycle) {
    const JointCommand next = stop.step(last.position, kCycle);
    EXPECT_GE(next.position, last.position);
    EXPECT_LE(next.velocity, last.velocity);
    EXPECT_EQ(next.stiffness, 60);
    last = next;
  }
  EXPECT_NEAR(last.velocity, (kFolding.posture - last.position) / 0.225, 0.01);
  EXPECT_LT(kFolding.posture - last.position, 0.1);
}

TEST(JointStop, DampsAloneAfterItsStiffnessFaded) {
  JointStop stop(kFolding);
  EXPECT_NEAR(followed(stop, 1.2).stiffness, 60 * 0.05 / 0.25, 1);
  const JointCommand last = followed(stop, 0.1, kFolding.posture);
  EXPECT_EQ(last.mode, JointMode::kVelocity);
  EXPECT_EQ(last.velocity, 0);
  EXPECT_EQ(last.damping, 2);
}

// The foot was in the air: it meets the ground when the others come as low.
TEST(JointStop, OfAJointThatIsAheadWaitsForTheOthers) {
  StopAction action = kFolding;
  action.upright = 0.3;
  JointStop ahead(action), usual(action);
  JointCommand waits{.position = 0.9}, other{.position = 0.3};
  for (double t = 0; t < 1.2; t += kCycle) {
    waits = ahead.step(waits.position, kCycle);
    other = usual.step(other.position, kCycle);
    EXPECT_NEAR(waits.position, std::max(0.9, other.position), 1e-9);
    EXPECT_EQ(waits.velocity, other.position < 0.9 ? 0 : other.velocity);
  }
}

TEST(JointStop, OfAJointThatIsBehindOrBeyondBeginsAtOnce) {
  StopAction action = kFolding;
  action.upright = kBegin;
  for (const double position : {0.2, 1.7}) {
    JointStop stop(action);
    EXPECT_NEAR(stop.step(position, kCycle).velocity, (kFolding.posture - position) / 0.8, 1e-9);
  }
}

TEST(JointStop, FoldsAgainFromWhereACommandLeftTheJoint) {
  JointStop stop(kFolding);
  followed(stop, 2);
  stop.release();
  const JointCommand again = stop.step(1.0, kCycle), first = JointStop(kFolding).step(1.0, kCycle);
  EXPECT_EQ(std::memcmp(&again, &first, sizeof first), 0);
}

TEST(JointStop, DampsAloneOnceItsTimeIsOverAndEndsAsTheBrakeOfTheDriver) {
  JointStop stop(kFolding);
  const double lying = kFolding.posture;
  EXPECT_EQ(stop.step(lying, kFolding.time).mode, JointMode::kVelocity);
  EXPECT_EQ(stop.step(lying, 0.19 * kFolding.time).mode, JointMode::kVelocity);
  EXPECT_EQ(stop.step(lying, 0.02 * kFolding.time).mode, JointMode::kBrake);
}

// Its encoder or its motor has failed: what folds and what damps would drive it on.
TEST(JointStop, OfAJointThatIsFarFromItsOrderIsTheBrakeOfTheDriverFromThereOn) {
  for (const double time : {0.4, 1.3}) {
    JointStop stop(kFolding);
    const JointCommand order = followed(stop, time);
    const double at = order.mode == JointMode::kImpedance ? order.position : kFolding.posture;
    EXPECT_NE(stop.step(at - 0.2, kCycle).mode, JointMode::kBrake);
    EXPECT_EQ(stop.step(at - 0.3, kCycle).mode, JointMode::kBrake);
    EXPECT_EQ(stop.step(at, kCycle).mode, JointMode::kBrake);
    stop.release();
    EXPECT_EQ(stop.step(kBegin, kCycle).mode, JointMode::kImpedance);
  }
}

TEST(JointStop, WithoutATimeIsTheBrakeOfTheDriver) {
  EXPECT_EQ(JointStop({.kind = StopKind::kFold}).step(kBegin, kCycle).mode, JointMode::kBrake);
}

TEST(JointStop, DampsAJointWithoutAPosition) {
  JointStop stop(kFolding);
  EXPECT_EQ(stop.step(std::nullopt, kCycle).mode, JointMode::kVelocity);
}

TEST(JointStop, DoesNotPassThePostureAfterALongGap) {
  JointStop stop(kFolding);
  stop.step(kBegin, kCycle);
  const JointCommand late = stop.step(kFolding.posture, 1.0);
  EXPECT_EQ(late.mode, JointMode::kImpedance);
  EXPECT_LE(late.position, kFolding.posture);
}

}  // namespace
}  // namespace robot_control
