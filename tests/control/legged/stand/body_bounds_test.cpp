#include "control/legged/stand/body_bounds.h"

#include <Eigen/QR>

#include "control/legged/ideal_legs.h"

namespace robot_control::tests {

class BodyBoundsOf : public testing::TestWithParam<std::string> {};

/// A body that is a point on the ground amid the feet would reach μ g ahead and sideways, and g upwards. Half of it is
/// allowed. Height, and legs that move with the body, take some more.
TEST_P(BodyBoundsOf, AreThoseOfFeetThatNeitherSlipNorLift) {
  const std::array<AxisBounds, 6> bounds = body_bounds(legged_robot(GetParam()));
  for (const std::size_t level : {0, 1}) {
    EXPECT_LT(bounds[level].acceleration, 0.5 * 0.5 * kGravity);
    EXPECT_GT(bounds[level].acceleration, 0.5 * 0.5 * 0.5 * kGravity);
  }
  EXPECT_NEAR(bounds[2].acceleration, 0.5 * kGravity, 0.2 * 0.5 * kGravity);
  for (const std::size_t turn : {3, 4, 5}) {
    EXPECT_GT(bounds[turn].acceleration, 10);
    EXPECT_LE(bounds[turn].speed, 0.9);
  }
  EXPECT_GT(bounds[3].acceleration, bounds[4].acceleration) << "a body that is longer than wide rolls more easily";
}

TEST_P(BodyBoundsOf, AreFiniteAndPositiveForLegsThatDoNotReachTheGround) {
  LegModel robot = legged_robot(GetParam());
  EXPECT_FALSE(nominal_stance(robot).short_leg.has_value());
  robot.belly += 10;  // m, and the ground with it
  robot.legs[0].foot_radius = -10;
  EXPECT_EQ(nominal_stance(robot).short_leg, LegPlace::kRearRight);
  for (const AxisBounds& bounds : body_bounds(robot)) {
    EXPECT_GE(bounds.acceleration, 0.1);
    EXPECT_LE(bounds.acceleration, 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, BodyBoundsOf, testing::ValuesIn(legged_robots()), robot_name);

/// Returns the forces that the feet of a standing robot need while its base moves, by LegDynamics. The rates of the
/// joints follow from inverse kinematics of two places of the base, the smallest forces from a decomposition.
std::array<Eigen::Vector3d, kLegs> forces_of(const IdealLegs& legs, int axis, double size) {
  constexpr double kMove = 1e-5;  // m or rad
  Eigen::Matrix<double, kLeggedDofs, 1> all = Eigen::Matrix<double, kLeggedDofs, 1>::Zero();
  Eigen::Matrix<double, 6, 3 * kLegs> map;
  all[axis] = size;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegKinematics& kinematics = legs.robot.legs[leg].kinematics;
    const Eigen::Vector3d foot = legs.foot_in_base(leg), unit = Eigen::Vector3d::Unit(axis % 3);
    const Eigen::Vector3d moved = foot - kMove * (axis < 3 ? unit : Eigen::Vector3d(unit.cross(foot)));
    all.segment<3>(static_cast<Eigen::Index>(6 + kLegJoints * leg)) =
        size / kMove * (kinematics.inverse(moved).angles - kinematics.inverse(foot).angles);
    for (int i = 0; i < 3; ++i) {
      map.col(3 * static_cast<int>(leg) + i) << Eigen::Vector3d::Unit(i), foot.cross(Eigen::Vector3d::Unit(i));
    }
  }
  const LeggedEquations equations = legs.at_rest();
  const Eigen::Matrix<double, kLeggedDofs, 1> efforts = equations.mass * all + equations.bias;
  const Eigen::Matrix<double, 3 * kLegs, 1> solved =
      map.completeOrthogonalDecomposition().solve(Eigen::Matrix<double, 6, 1>(efforts.head<6>()));
  std::array<Eigen::Vector3d, kLegs> forces;
  for (std::size_t leg = 0; leg < kLegs; ++leg) forces[leg] = solved.segment<3>(3 * static_cast<int>(leg));
  return forces;
}

/// With f₀ and f₁ of a foot, μ f₀z ≥ A (|f₁xy| + μ |f₁z|), μ = 0.5. The body uses half of it.
TEST(BodyBounds, UseHalfOfWhatTheFirstFootToSlipCarries) {
  const IdealLegs legs = standing();
  const std::array<AxisBounds, 6> bounds = body_bounds(legs.robot);
  const std::array<Eigen::Vector3d, kLegs> weight = forces_of(legs, 0, 0);
  for (int axis = 0; axis < 6; ++axis) {
    const std::array<Eigen::Vector3d, kLegs> moved = forces_of(legs, axis, 1);
    double least = 1e9;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const Eigen::Vector3d change = moved[leg] - weight[leg];
      least = std::min(least, 0.5 * weight[leg].z() / (change.head<2>().norm() + 0.5 * std::abs(change.z())));
    }
    // The centre of gravity comes amid the feet by one step of an iteration.
    EXPECT_NEAR(bounds[static_cast<std::size_t>(axis)].acceleration, 0.5 * least, 0.02 * least) << axis;
  }
}

TEST(BodyBounds, HaveSpeedsThatGrowWithTheRootOfTheLegs) {
  const LegModel robot = legged_robot("quadbot");
  ASSERT_NEAR(robot.leg_length(), 0.426, 1e-6);
  const auto speeds = [](const LegModel& model) {
    const std::array<AxisBounds, 6> bounds = body_bounds(model);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(bounds[i].speed, bounds[0].speed) << i;
      EXPECT_EQ(bounds[3 + i].speed, bounds[3].speed) << i;
    }
    return std::array{bounds[0].speed, bounds[3].speed};
  };
  EXPECT_NEAR(speeds(robot)[0], 0.4, 1e-6);
  EXPECT_NEAR(speeds(robot)[1], 0.9, 1e-6);
  for (const double scale : {0.5, 4.0}) {
    LegModel other = robot;
    for (Leg& leg : other.legs) {
      LegGeometry geometry = leg.kinematics.geometry();
      geometry.lower *= scale;
      geometry.foot *= scale;
      leg.kinematics = LegKinematics(geometry);
    }
    EXPECT_NEAR(speeds(other)[0], 0.4 * std::sqrt(scale), 1e-6);
    EXPECT_NEAR(speeds(other)[1], scale > 1 ? 0.9 / std::sqrt(scale) : 0.9, 1e-6) << "tip_over bounds it";
  }
}

TEST(BodyBounds, FindALegThatIsTooShortAtEachCorner) {
  for (std::size_t leg = 1; leg < kLegs; ++leg) {  // the height is that of the first one
    LegModel robot = lopsided();
    LegGeometry geometry = robot.legs[leg].kinematics.geometry();
    geometry.hip.z() += 0.3;
    robot.legs[leg].kinematics = LegKinematics(geometry);
    EXPECT_EQ(nominal_stance(robot).short_leg, static_cast<LegPlace>(leg));
  }
  EXPECT_EQ(nominal_stance(lopsided()).short_leg, std::nullopt);
}

/// Terms of the header: n/w + 2w of the body, the foot's way, its load, the rise.
TEST(LyingDownTime, IsThatOfTheFootThenOfTheBodyThenOfTheRise) {
  const LegModel robot = legged_robot("quadbot");
  const std::array<AxisBounds, 6> bounds = body_bounds(robot);
  const LegTuning tuning = leg_tuning(robot);
  const auto norm_of = [&](std::size_t axis, double range) { return range / bounds[axis].acceleration; };
  const double n = norm_of(0, tuning.sway) + norm_of(1, tuning.sway) + norm_of(2, tuning.bob) +
                   norm_of(3, tuning.lean) + norm_of(4, tuning.lean) + norm_of(5, tuning.lean);
  const double slowest =
      std::max({tuning.sway / bounds[0].speed, tuning.bob / bounds[2].speed, tuning.lean / bounds[3].speed});
  const double w = std::min(std::sqrt(n), n / slowest);
  const double foot = (tuning.foot_range + tuning.lift + tuning.foot_range) / 0.5 + 4 * 0.5 / 15 + 0.2;
  EXPECT_NEAR(lying_down_time(robot), foot + n / w + 2 * w + 0.05 + 1.3, 1e-6);
}

}  // namespace robot_control::tests
