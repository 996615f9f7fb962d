#include "control/legged/stand/foot_forces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>

namespace robot_control::tests {

/// Feet at four heights, and a load under which all push.
FootForcesInput uneven() {
  FootForcesInput input;
  input.feet = {Eigen::Vector3d(0.21, 0.12, -0.3), Eigen::Vector3d(0.19, -0.15, -0.27),
                Eigen::Vector3d(-0.2, 0.14, -0.31), Eigen::Vector3d(-0.17, -0.13, -0.25)};
  input.share = {1, 0.8, 0.6, 0.9};
  input.force = {8, -5, 120};
  input.moment = {1.5, -2, 0.7};
  return input;
}

/// Returns the forces of the smallest Σ |fᵢ|²/wᵢ: with fᵢ = √wᵢ yᵢ, the shortest y that gives force and moment.
std::array<Eigen::Vector3d, kLegs> smallest(const FootForcesInput& input) {
  Eigen::Matrix<double, 6, 3 * kLegs> map;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d unit = std::sqrt(input.share[leg]) * Eigen::Vector3d::Unit(axis);
      map.col(3 * static_cast<int>(leg) + axis) << unit, input.feet[leg].cross(unit);
    }
  }
  Eigen::Matrix<double, 6, 1> load;
  load << input.force, input.moment;
  const Eigen::Matrix<double, 3 * kLegs, 1> y = map.completeOrthogonalDecomposition().solve(load);
  std::array<Eigen::Vector3d, kLegs> forces;
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    forces[leg] = std::sqrt(input.share[leg]) * y.segment<3>(3 * static_cast<int>(leg));
  return forces;
}

TEST(FootForces, AreTheSmallestThatGiveForceAndMoment) {
  const FootForcesInput input = uneven();
  const std::array<Eigen::Vector3d, kLegs> forces = foot_forces(input), expected = smallest(input);
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    EXPECT_LE((forces[leg] - expected[leg]).norm(), 1e-9) << leg;
    force += forces[leg];
    moment += input.feet[leg].cross(forces[leg]);
  }
  EXPECT_LE((force - input.force).norm(), 1e-9);
  EXPECT_LE((moment - input.moment).norm(), 1e-9);
}

TEST(FootForces, LeaveAFootWithoutAShareUnloaded) {
  for (std::size_t lifted = 0; lifted < kLegs; ++lifted) {
    FootForcesInput input = uneven();
    input.share.fill(1);
    input.share[lifted] = 0;
    // The weight stands on the middle of the three others.
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t leg = 0; leg < kLegs; ++leg) middle += (leg == lifted ? 0 : 1 / 3.0) * input.feet[leg];
    input.force = {0, 0, 90};
    input.moment = middle.cross(input.force);
    const std::array<Eigen::Vector3d, kLegs> forces = foot_forces(input);
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      EXPECT_LE((forces[leg] - Eigen::Vector3d(0, 0, leg == lifted ? 0 : 30)).norm(), 1e-9) << lifted << leg;
  }
}

TEST(FootForces, NeverPull) {
  FootForcesInput input = uneven();
  input.force = {0, 0, 20};
  input.moment = {0, -10, 0};  // to the front
  const std::array<Eigen::Vector3d, kLegs> expected = smallest(input), forces = foot_forces(input);
  ASSERT_LT(expected[2].z(), 0);
  ASSERT_GT(expected[0].z(), 0);
  EXPECT_EQ(forces[2], Eigen::Vector3d::Zero());
  EXPECT_LE((forces[0] - expected[0]).norm(), 1e-9);
  input.up = -input.up;
  EXPECT_EQ(foot_forces(input)[0], Eigen::Vector3d::Zero());
  EXPECT_LE((foot_forces(input)[2] - expected[2]).norm(), 1e-9);
}

TEST(FootForces, AreZeroForALoadThatIsNoNumber) {
  FootForcesInput input = uneven();
  input.force.x() = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector3d& force : foot_forces(input)) EXPECT_EQ(force, Eigen::Vector3d::Zero());
}

}  // namespace robot_control::tests
