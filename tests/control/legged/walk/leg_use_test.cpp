#include "control/legged/walk/leg_use.h"

#include "control/legged/ideal_legs.h"
#include "control/legged/walk/walking_speed.h"

namespace robot_control::tests {

struct LegUseTest : testing::Test {
  LegModel robot = legged_robot("quadbot");
  NominalStance stance = nominal_stance(robot);
  Gait trot = gait_of(robot, stance, kGaits[gait_named("trot")]);
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
  EXPECT_LT(steady({0.5, 0, 0}), kSpeedShare);
  EXPECT_EQ(steady({0.5, 0, 0}, {0.12, 0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(steady({0.5, 0, 0}, {0.05, 0.15, 0.15}), std::numeric_limits<double>::infinity());
}

/// A trot in place that lifts no foot keeps the joints where they stand.
TEST_F(LegUseTest, IsInfiniteWhereAJointLeavesItsRangeOrComesNearItsEndInAPose) {
  constexpr double kLittle = 1e-6;
  trot.lift = 0;
  const LegGeometry whole = robot.legs[1].kinematics.geometry();
  const LegAngles angles = robot.legs[1].kinematics.inverse(stance.feet[1]).angles;
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const double angle = angles[static_cast<Eigen::Index>(i)];
    const auto reaches = [&](double below, double above, const CarriedBody& body) {
      LegGeometry geometry = whole;
      geometry.range[i] = {angle - below, angle + above};
      robot.legs[1].kinematics = LegKinematics(geometry);
      return std::isfinite(steady({}, body));
    };
    for (const auto& [end, body] : {std::pair{0.0, CarriedBody{}}, {kFromEnd, CarriedBody{0, kLittle / 10, 0}}}) {
      EXPECT_TRUE(reaches(end + kLittle, end + kLittle, body)) << i;
      EXPECT_FALSE(reaches(end - kLittle, 1, body)) << i;
      EXPECT_FALSE(reaches(1, end - kLittle, body)) << i;
    }
  }
}

/// The hip bears half of the weight beside its axis, in a trot on the spot.
TEST_F(LegUseTest, CountsTheTorqueOfHalfOfTheWeight) {
  const double lever = std::abs(stance.feet[0].y() - robot.legs[0].kinematics.geometry().hip.y());
  robot.joints[0].effort_limit = robot.mass * kGravity / 2 * lever / (2 * kEffortShare);
  EXPECT_NEAR(steady({}), 2 * kSpeedShare, 1e-6);
}

/// Forces through the centre of gravity load a hip alike wherever the feet of a walk to the side are.
TEST_F(LegUseTest, HipsBearAWalkToTheSideAsTheyBearTheRobotOnTheSpot) {
  for (std::size_t leg = 0; leg < kLegs; ++leg) robot.joints[kLegJoints * leg].effort_limit /= 8;
  EXPECT_NEAR(steady({0, 0.3, 0}) / steady({}), 1, 0.03);
  EXPECT_GT(steady({0, 0, 1}) / steady({}), 1.1);
}

/// The feet stay where they are while the body moves through the pose.
TEST_F(LegUseTest, CountsTheRatesOfThePose) {
  constexpr double kStep = 1e-6;  // s
  const CarriedBody body{0.01, 0.05, -0.08};
  const Eigen::Vector3d& centre = stance.equations.centre_of_gravity;
  const auto angles_in = [&](std::size_t leg, const CarriedBody& pose) {
    const Eigen::Matrix3d back =
        (Eigen::AngleAxisd(-pose[1], Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(-pose[2], Eigen::Vector3d::UnitY()))
            .toRotationMatrix();
    const Eigen::Vector3d foot = back * (stance.feet[leg] - centre) + centre - pose[0] * back.col(2);
    return robot.legs[leg].kinematics.inverse(foot).angles;
  };
  trot.lift = 0;
  for (const CarriedBody& rates : {CarriedBody{0.3, 0, 0}, CarriedBody{0, 0, 1}, CarriedBody{0, -0.7, 0}}) {
    double fastest = 0;  // of the limit
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      CarriedBody later = body;
      for (std::size_t axis = 0; axis < later.size(); ++axis) later[axis] += kStep * rates[axis];
      const auto joint = static_cast<Eigen::Index>(i % kLegJoints);
      const double turned = angles_in(i / kLegJoints, later)[joint] - angles_in(i / kLegJoints, body)[joint];
      fastest = std::max(fastest, std::abs(turned) / kStep / robot.joints[i].velocity_limit);
    }
    EXPECT_NEAR(LegUse(robot, stance).swinging(trot, {}, body, 8, rates), fastest, 1e-4 * fastest);
  }
}

TEST_F(LegUseTest, GrowsWithALeanThatTurnsTheJointsFaster) {
  const WalkingTwist twist{0.8, 0.1, 0.3};
  EXPECT_NE(steady(twist, {0, 0.1, 0}), steady(twist, {0, -0.1, 0}));
  EXPECT_EQ(steady(twist, {0, 0, 0}), steady(twist));
}

}  // namespace robot_control::tests
