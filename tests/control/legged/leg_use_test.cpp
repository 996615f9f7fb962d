#include "control/legged/walking/leg_use.h"

#include <gtest/gtest.h>

#include "control/legged/ideal_legs.h"
#include "control/legged/walking/walking_speed.h"

namespace robot_control {
namespace {

struct LegUseTest : testing::Test {
  LegModel robot = legged_robot("quadbot");
  NominalStance stance = nominal_stance(robot);
  Gait trot = gait_of(robot, stance, kGaits[static_cast<std::size_t>(GaitName::kTrot)]);
  double steady(const WalkingTwist& twist, const CarriedBody& body = {}) const {
    return LegUse(robot, stance).steady(trot, twist, body);
  }
};

TEST_F(LegUseTest, IsThatOfTheSameStanceInAnotherPose) {
  constexpr double kRaised = 0.01;
  NominalStance raised = stance;
  for (Eigen::Vector3d& foot : raised.feet) foot.z() -= kRaised;
  const WalkingTwist twist{0.6, 0, 0};
  EXPECT_NEAR(LegUse(robot, raised).steady(trot, twist), steady(twist, {kRaised, 0, 0}), 1e-12);
}

TEST_F(LegUseTest, IsInfiniteWhereALegReachesItsFootNoMore) {
  EXPECT_LT(steady({0.5, 0, 0}), kOfJointSpeed);
  EXPECT_EQ(steady({0.5, 0, 0}, {0.12, 0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(steady({0.5, 0, 0}, {0.05, 0.15, 0.15}), std::numeric_limits<double>::infinity());
}

/// The hip bears half of the weight beside its axis, in a trot on the spot.
TEST_F(LegUseTest, CountsTheTorqueOfHalfOfTheWeight) {
  const double lever = std::abs(stance.feet[0].y() - robot.legs[0].kinematics.geometry().hip.y());
  robot.joints[0].effort_limit = robot.mass * kGravity / 2 * lever / (2 * kOfWeight);
  EXPECT_NEAR(steady({}), 2 * kOfJointSpeed, 1e-6);
}

TEST_F(LegUseTest, GrowsWithALeanThatTurnsTheJointsFaster) {
  const WalkingTwist twist{0.8, 0.1, 0.3};
  EXPECT_NE(steady(twist, {0, 0.1, 0}), steady(twist, {0, -0.1, 0}));
  EXPECT_EQ(steady(twist, {0, 0, 0}), steady(twist));
}

}  // namespace
}  // namespace robot_control
