#include "machine/legs/leg_dynamics.h"

#include "machine/legs/legs_corpus.h"
#include "machine/legs/mujoco_equations.h"
#include "support/allocation_guard.h"

namespace robot_control {
namespace {

class LegDynamicsOf : public testing::TestWithParam<std::string> {
 protected:
  LegModel robot_ = legged_robot(GetParam());
};

TEST_P(LegDynamicsOf, AgreesWithMujocoInMassMatrixAndBias) {
  const EquationsDifference difference = difference_from_mujoco(robot_, 50);
  EXPECT_LE(difference.mass, 1e-9);
  EXPECT_LE(difference.bias, 1e-9);
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

}  // namespace
}  // namespace robot_control
