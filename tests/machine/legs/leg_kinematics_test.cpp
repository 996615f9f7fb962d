#include "machine/legs/leg_kinematics.h"

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/tree.hpp>
#include <random>

#include "machine/bodies/kdl_tree.h"
#include "machine/description/urdf_document.h"
#include "machine/legs/legs_corpus.h"

namespace robot_control::tests {

constexpr double kWhole = 3.14159265358979323846;

LegAngles random_angles(const LegKinematics& leg, std::mt19937_64& random) {
  LegAngles angles;
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const JointRange& range = leg.range(i);
    std::uniform_real_distribution<double> draw(std::max(range.lower, -kWhole), std::min(range.upper, kWhole));
    angles[static_cast<Eigen::Index>(i)] = draw(random);
  }
  return angles;
}

bool in_range(const LegKinematics& leg, const LegAngles& angles) {
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const double angle = angles[static_cast<Eigen::Index>(i)];
    if (angle < leg.range(i).lower || angle > leg.range(i).upper) return false;
  }
  return true;
}

struct LegKinematicsOf : testing::TestWithParam<std::string> {
  LegModel robot_ = legged_robot(GetParam());
  std::mt19937_64 random_{31};
};

/// KDL turns the same chain joint by joint; its rounding is that of three products of frames.
TEST_P(LegKinematicsOf, AgreesWithKdlInPositionAndJacobian) {
  const KDL::Tree tree = kdl_tree(parse_urdf(legged_description(GetParam())));
  for (std::size_t place = 0; place < kLegs; ++place) {
    KDL::Chain chain;
    ASSERT_TRUE(tree.getChain(robot_.base_link, robot_.joints[3 * place + 2].child_link, chain));
    ASSERT_EQ(chain.getNrOfJoints(), 3u);
    const LegKinematics& leg = robot_.legs[place].kinematics;
    KDL::ChainFkSolverPos_recursive position(chain);
    KDL::ChainJntToJacSolver jacobian(chain);
    KDL::Frame zero;
    position.JntToCart(KDL::JntArray(3), zero);
    const Eigen::Vector3d at_zero = leg.position(LegAngles::Zero());
    const KDL::Vector foot = zero.Inverse() * KDL::Vector(at_zero.x(), at_zero.y(), at_zero.z());
    for (int trial = 0; trial < 100; ++trial) {
      const LegAngles angles = random_angles(leg, random_);
      KDL::JntArray q(3);
      q.data = angles;
      KDL::Frame frame;
      KDL::Jacobian columns(3);
      position.JntToCart(q, frame);
      jacobian.JntToJac(q, columns);
      columns.changeRefPoint(frame.M * foot);
      const KDL::Vector expected = frame * foot;
      Eigen::Vector3d ours;
      const Eigen::Matrix3d our_columns = leg.jacobian(angles, ours);
      EXPECT_LE((ours - Eigen::Vector3d(expected.x(), expected.y(), expected.z())).norm(), 1e-11);
      EXPECT_LE((our_columns - columns.data.topRows<3>()).norm(), 1e-11);
      EXPECT_LE((leg.position(angles) - ours).norm(), 1e-15);
    }
  }
}

/// The lever is that of the Jacobian, for a force along the line in the leg's plane.
TEST_P(LegKinematicsOf, KnowsTheStretchOfTheLegAndTheLeverOfItsKnee) {
  for (const Leg& each : robot_.legs) {
    const LegKinematics& leg = each.kinematics;
    const LegGeometry& geometry = leg.geometry();
    for (int i = 0; i < 100; ++i) {
      const LegAngles angles = random_angles(leg, random_);
      Eigen::Vector3d foot;
      const Eigen::Matrix3d jacobian = leg.jacobian(angles, foot);
      const Eigen::AngleAxisd swung(geometry.sign[0] * angles[0], Eigen::Vector3d::UnitX());
      Eigen::Vector3d line = foot - geometry.hip - swung * geometry.upper;
      line -= line.dot(swung * Eigen::Vector3d::UnitY()) * (swung * Eigen::Vector3d::UnitY());
      const double stretch = leg.stretch(angles);
      EXPECT_NEAR(stretch, line.norm(), 1e-12);
      EXPECT_NEAR(leg.knee_lever(stretch), std::abs(jacobian.col(2).dot(line)) / stretch, 1e-6);
    }
  }
}

TEST_P(LegKinematicsOf, FindsAnglesForEveryReachableFoot) {
  for (int trial = 0; trial < 1000; ++trial) {
    const LegKinematics& leg = robot_.legs[static_cast<std::size_t>(trial) % kLegs].kinematics;
    const Eigen::Vector3d foot = leg.position(random_angles(leg, random_));
    const LegSolution solution = leg.inverse(foot);
    EXPECT_EQ(solution.reach, FootReach::kReached) << trial;
    EXPECT_TRUE(in_range(leg, solution.angles)) << trial;
    EXPECT_LE((leg.position(solution.angles) - foot).norm(), 1e-12) << trial;
  }
}

/// No other angles within the ranges, of a grid of 25³, bring the foot nearer.
TEST_P(LegKinematicsOf, GivesTheNearestPointOfAFootBeyondReach) {
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int trial = 0; trial < 40; ++trial) {
    const LegKinematics& leg = robot_.legs[static_cast<std::size_t>(trial) % kLegs].kinematics;
    const Eigen::Vector3d foot =
        leg.geometry().hip + 2.5 * leg.length() * Eigen::Vector3d(draw(random_), draw(random_), draw(random_));
    const LegSolution solution = leg.inverse(foot);
    if (solution.reach == FootReach::kReached) continue;
    ASSERT_TRUE(in_range(leg, solution.angles)) << trial;
    const double distance = (leg.position(solution.angles) - foot).norm();
    constexpr int kGrid = 24;
    double best = 1e9;
    for (int i = 0; i <= kGrid; ++i) {
      for (int j = 0; j <= kGrid; ++j) {
        for (int k = 0; k <= kGrid; ++k) {
          LegAngles angles;
          const double parts[3] = {double(i) / kGrid, double(j) / kGrid, double(k) / kGrid};
          for (std::size_t n = 0; n < 3; ++n) {
            const double low = std::max(leg.range(n).lower, -kWhole), high = std::min(leg.range(n).upper, kWhole);
            angles[static_cast<Eigen::Index>(n)] = low + parts[n] * (high - low);
          }
          best = std::min(best, (leg.position(angles) - foot).norm());
        }
      }
    }
    EXPECT_LE(distance, best + 1e-9) << "trial " << trial << ", foot " << foot.transpose();
  }
}

/// The thighs of anymal turn by three turns. Their angles once jumped by one where a foot left the reach.
TEST_P(LegKinematicsOf, FollowsAFootBeyondReachWithoutAJump) {
  constexpr int kSteps = 400;
  std::uniform_real_distribution<double> draw(-1, 1);
  for (const Leg& each : robot_.legs) {
    const LegKinematics& leg = each.kinematics;
    const Eigen::Vector3d below = leg.geometry().hip - 0.7 * leg.length() * Eigen::Vector3d::UnitZ();
    for (int trial = 0; trial < 10; ++trial) {
      const Eigen::Vector3d way = leg.length() * Eigen::Vector3d(draw(random_), draw(random_), 0.3 * draw(random_));
      double thigh = leg.inverse(below).angles[1];
      for (int i = 1; i <= kSteps; ++i) {
        const LegSolution solution = leg.inverse(below + static_cast<double>(i) / kSteps * way);
        EXPECT_NEAR(solution.angles[1], thigh, 1) << "trial " << trial << ", step " << i;
        thigh = solution.angles[1];
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, LegKinematicsOf, testing::ValuesIn(legged_robots()), robot_name);

TEST(LegKinematics, TellsReachAndRangeApart) {
  const LegKinematics leg = legged_robot("quadbot").legs[0].kinematics;
  const Eigen::Vector3d hip = leg.geometry().hip;
  EXPECT_EQ(leg.inverse(hip + Eigen::Vector3d(0, 0.08, -1)).reach, FootReach::kBeyondReach);
  EXPECT_EQ(leg.inverse(hip + Eigen::Vector3d(0, 0.02, 0)).reach, FootReach::kBeyondReach);  // inside of the offset
  EXPECT_EQ(leg.inverse(hip + Eigen::Vector3d(0, -0.25, -0.1)).reach, FootReach::kBeyondRange);
  EXPECT_EQ(leg.inverse(hip + Eigen::Vector3d(0, 0.08, -0.3)).reach, FootReach::kReached);
}

}  // namespace robot_control::tests
