#include "machine/legs/leg_dynamics.h"

#include <cmath>

#include "machine/legs/legs_corpus.h"
#include "machine/legs/mujoco_equations.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

struct LegDynamicsOf : testing::TestWithParam<std::string> {
  LegModel robot_ = legged_robot(GetParam());
};

TEST_P(LegDynamicsOf, AgreesWithMujocoInMassMatrixAndBias) {
  const EquationsDifference difference = difference_from_mujoco(robot_, 50);
  EXPECT_LE(difference.mass, 1e-9);
  EXPECT_LE(difference.bias, 1e-9);
}

TEST_P(LegDynamicsOf, GivesTheEffortsOfOneLegLikeThoseOfAll) {
  const LegDynamics dynamics(robot_);
  LeggedMotion motion;
  LeggedAcceleration change;
  Eigen::Matrix<double, kLeggedDofs, 1> acceleration;
  acceleration << 0.5, -1, 2, 3, -4, 5, Eigen::Matrix<double, kLegsJoints, 1>::Zero();
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const auto number = static_cast<double>(i);
    motion.angles[i] = std::sin(number);
    motion.rates[i] = 2 * std::cos(3 * number);
    acceleration[6 + static_cast<Eigen::Index>(i)] = change.joints[i] = 10 * std::sin(5 * number);
  }
  motion.linear = {0.3, -0.2, 0.1};
  motion.angular = {1, -2, 0.5};
  LeggedEquations all;
  dynamics.step(motion, all);
  const Eigen::Matrix<double, kLeggedDofs, 1> efforts = all.mass * acceleration + all.bias;
  change.angular = acceleration.segment<3>(3);
  motion.gravity -= acceleration.head<3>();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const auto row = static_cast<Eigen::Index>(6 + kLegJoints * leg);
    EXPECT_LE((dynamics.efforts(leg, motion, change) - efforts.segment<3>(row)).norm(), 1e-9) << leg;
  }
}

TEST_P(LegDynamicsOf, AllocatesNothing) {
  const LegDynamics dynamics(robot_);
  LeggedMotion motion;
  LeggedEquations equations;
  Eigen::Vector3d foot;
  const AllocationGuard guard;
  dynamics.step(motion, equations);
  for (const Leg& leg : robot_.legs) {
    foot = leg.kinematics.position(leg.lying);
    leg.kinematics.jacobian(leg.lying, foot);
    leg.kinematics.inverse(foot);
    leg.kinematics.inverse(3 * foot);
  }
  EXPECT_EQ(guard.count(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Robots, LegDynamicsOf, testing::ValuesIn(legged_robots()), robot_name);

}  // namespace robot_control::tests
