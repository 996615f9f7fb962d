#include "control/legged/joints/joint_motion.h"

#include "control/legged/ideal_legs.h"

namespace robot_control::tests {

constexpr double kStep = 0.01;  // s
using Positions = std::array<double, kLegsJoints>;

struct JointMotionOf : testing::Test {
  JointMotionOf() {
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      start_[i] = 0.1 * static_cast<double>(i);
      target_[i] = start_[i] + 0.05 + 0.01 * static_cast<double>(i);
      bounds_[i].motion = {.speed = 3, .acceleration = 15};
    }
    motion_.begin(start_);
  }
  Positions start_{}, target_{};
  AllJointBounds bounds_{};
  JointMotion motion_;
};

TEST_F(JointMotionOf, BeginsAtRestWhereTheJointsAre) {
  motion_.follow(target_, true, bounds_, kStep);
  motion_.begin(start_);
  EXPECT_EQ(motion_.follows, 0u);
  EXPECT_EQ(motion_.left, 0);
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    EXPECT_EQ(motion_.axes[i].value, start_[i]);
    EXPECT_EQ(motion_.axes[i].speed, 0);
    EXPECT_EQ(motion_.reference[i], start_[i]);
  }
}

TEST_F(JointMotionOf, MovesTheReferenceStraightAndIsThereAfterTheHorizon) {
  for (int k = 1; k <= 12; ++k) {
    motion_.follow(target_, k == 1, bounds_, kStep);
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      EXPECT_NEAR(motion_.reference[i], start_[i] + std::min(1.0, 0.1 * k) * (target_[i] - start_[i]), 1e-9) << k;
  }
}

TEST_F(JointMotionOf, BeginsTheHorizonAgainWithEachRequest) {
  for (int k = 0; k < 5; ++k) motion_.follow(target_, k == 0, bounds_, kStep);
  motion_.follow(target_, true, bounds_, kStep);
  EXPECT_NEAR(motion_.reference[0], start_[0] + 0.55 * (target_[0] - start_[0]), 1e-9);
}

TEST_F(JointMotionOf, LetsEachJointFollowItsReferenceWithinItsOwnBounds) {
  bounds_[3].motion.speed = 0.2;
  bounds_[4].motion.acceleration = 1;
  for (int k = 0; k < 60; ++k) {
    const JointMotion before = motion_;
    motion_.follow(target_, k == 0, bounds_, kStep);
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      EXPECT_LE(std::abs(motion_.axes[i].speed), bounds_[i].motion.speed + 1e-9);
      EXPECT_LE(std::abs(motion_.axes[i].speed - before.axes[i].speed), bounds_[i].motion.acceleration * kStep + 1e-9);
    }
    if (k == 12) {
      EXPECT_NEAR(motion_.axes[2].value, target_[2], 0.02);
      EXPECT_GT(target_[3] - motion_.axes[3].value, 0.04) << "it is slower than its reference";
    }
  }
  for (const std::size_t i : {0, 3, 11}) EXPECT_NEAR(motion_.axes[i].value, target_[i], 1e-3) << i;
}

TEST_F(JointMotionOf, StopsEachJointAsItsAccelerationAllows) {
  for (int k = 0; k < 8; ++k) motion_.follow(target_, k == 0, bounds_, kStep);
  const JointMotion moving = motion_;
  ASSERT_EQ(moving.follows, 1u);
  ASSERT_GT(moving.axes[11].speed, 0.5);
  for (int k = 0; k < 50; ++k) motion_.stop(bounds_, kStep);
  EXPECT_EQ(motion_.follows, 0u);
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const double speed = moving.axes[i].speed;
    EXPECT_NEAR(motion_.reference[i], moving.axes[i].value + speed * speed / 30, 1e-9) << i;
    EXPECT_NEAR(motion_.axes[i].value, motion_.reference[i], 1e-6) << i;
  }
}

/// The joints phase of the controller.
struct LyingJoints : testing::Test {
  LyingJoints() {
    for (std::size_t i = 0; i < kLegsJoints; ++i) start_[i] = legs_.sensors.joints[i].position;
  }
  Request near(double distance) const {
    Request request = stance_of({ModeKind::kJoints});
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const JointRange& range = *legs_.robot.joints[i].range;
      const double inside = std::clamp(start_[i], range.lower, range.upper);
      request.joints[i] = inside + std::copysign(distance, (range.lower + range.upper) / 2 - inside);
    }
    return request;
  }
  IdealLegs legs_{lopsided(), kCycle, 1.0};
  Positions start_{};
};

TEST_F(LyingJoints, GoToTheRequestWithinTheirBounds) {
  const Request wanted = near(0.2);
  const AllJointBounds bounds = joint_bounds(legs_.robot);
  legs_.step(wanted);
  EXPECT_EQ(legs_.out.legged.phase, LegPhase::kJoints);
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    EXPECT_EQ(legs_.out.joints[i].position, start_[i]);
    EXPECT_EQ(legs_.out.joints[i].velocity, 0);
  }
  for (int k = 0; k < 100; ++k) {
    legs_.step();
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      EXPECT_LE(std::abs(legs_.out.joints[i].velocity), bounds[i].motion.speed + 1e-9);
  }
  for (std::size_t i = 0; i < kLegsJoints; ++i) EXPECT_NEAR(legs_.out.joints[i].position, wanted.joints[i], 1e-4) << i;
  EXPECT_EQ(legs_.out.reasons, 0u);
}

TEST_F(LyingJoints, AreThereAHorizonAfterTheRequest) {
  legs_.run(0.2, near(0));
  const Request wanted = near(0.02);
  legs_.run(0.1, wanted);
  EXPECT_NEAR(legs_.state().joints.reference[5], wanted.joints[5], 1e-9);
  EXPECT_NEAR(legs_.out.joints[5].position, wanted.joints[5], 0.005);
}

TEST_F(LyingJoints, StopAtTheEndsOfTheirRanges) {
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    for (const double side : {-1.0, 1.0}) {
      IdealLegs legs = legs_;
      Request wanted = near(0);
      wanted.joints[i] = 9 * side;
      for (int k = 0; k < 8; ++k) legs.run(0.5, wanted);
      const JointRange& range = *legs.robot.joints[i].range;
      EXPECT_NEAR(legs.out.joints[i].position, side < 0 ? range.lower : range.upper, 1e-6) << i;
      EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonOutOfReach});
    }
  }
}

TEST_F(LyingJoints, NameAPositionBeyondTheirRange) {
  Request wanted = near(0);
  legs_.run(0.1, wanted);
  EXPECT_EQ(legs_.out.reasons & kReasonOutOfReach, 0u);
  wanted.joints[7] = 9;
  legs_.step(wanted);
  EXPECT_NE(legs_.out.reasons & kReasonOutOfReach, 0u);
}

TEST_F(LyingJoints, StayWhereTheyAreAfterTheRequestHasTimedOut) {
  legs_.run(0.05, near(0.5));
  const double distance = std::abs(legs_.out.joints[2].position - start_[2]);
  ASSERT_GT(distance, 0.001);
  legs_.run(0.3, {});
  EXPECT_EQ(legs_.out.legged.phase, LegPhase::kJoints);
  const Positions rest = legs_.state().stand.angles;
  EXPECT_LT(std::abs(rest[2] - start_[2]), 0.3);
  legs_.run(0.5, {});
  for (std::size_t i = 0; i < kLegsJoints; ++i) EXPECT_NEAR(legs_.out.joints[i].position, rest[i], 1e-6);
  legs_.step(stance_of({ModeKind::kLie}));
  EXPECT_EQ(legs_.out.legged.phase, LegPhase::kLying);
}

TEST_F(LyingJoints, CarryTheirOwnWeightAlone) {
  legs_.run(2.0, near(0.2));
  const LeggedEquations equations = legs_.at_rest();
  for (std::size_t i = 0; i < kLegsJoints; ++i)
    EXPECT_NEAR(legs_.out.joints[i].effort, equations.bias[static_cast<Eigen::Index>(6 + i)], 1e-6) << i;
}

}  // namespace robot_control::tests
