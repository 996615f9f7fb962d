/// MuJoCo is the oracle. Its velocities of the base are linear in world axes and angular in the base's.

#include "machine/legs/leg_dynamics.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "drivers/mujoco/model/mujoco_model.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/legs_corpus.h"
#include "support/allocation_guard.h"

namespace robot_control {
namespace {

using Matrix18 = Eigen::Matrix<double, kLeggedDofs, kLeggedDofs, Eigen::RowMajor>;

/// MuJoCo turns inertias to their principal axes only within 10⁻⁸; these are exact.
void set_exact_inertias(const LegModel& robot, mjModel& model) {
  for (const RigidBody& body : robot.bodies->bodies) {
    const int id = mj_name2id(&model, mjOBJ_BODY, body.name.c_str());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(body.inertia);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(0) *= -1;
    const Eigen::Quaterniond turn(axes);
    const double quaternion[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
    std::copy_n(quaternion, 4, model.body_iquat + 4 * id);
    std::copy_n(solver.eigenvalues().data(), 3, model.body_inertia + 3 * id);
  }
}

class LegDynamicsOf : public testing::TestWithParam<std::string> {
 protected:
  LegModel robot_ = legged_robot(GetParam());
};

TEST_P(LegDynamicsOf, AgreesWithMujocoInMassMatrixAndBias) {
  MujocoPlantParameters parameters;
  parameters.scene = PROJECT_DIRECTORY "/urdf/scenes/flat.xml";
  const MujocoModel simulated = compile_model(robot_, parameters, 0.001);
  mjModel& model = *simulated.model;
  ASSERT_EQ(model.nv, kLeggedDofs);
  for (const int dof : simulated.joint_velocity) model.dof_armature[dof] = robot_.rotor_inertia;
  set_exact_inertias(robot_, model);
  const MujocoData data = set_down(simulated);
  const LegDynamics dynamics(robot_);
  std::mt19937_64 random(31);
  std::normal_distribution<double> draw;
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(draw(random), draw(random), draw(random), draw(random)).normalized();
    LeggedMotion motion;
    motion.linear = {draw(random), draw(random), draw(random)};
    motion.angular = {2 * draw(random), 2 * draw(random), 2 * draw(random)};
    motion.gravity =
        turn.conjugate() * Eigen::Vector3d(model.opt.gravity[0], model.opt.gravity[1], model.opt.gravity[2]);
    const Eigen::Vector3d linear_world = turn * motion.linear;
    mjtNum* pose = data->qpos + simulated.base_position;
    for (int axis = 0; axis < 3; ++axis) {
      pose[axis] = 10 + axis;
      data->qvel[simulated.base_velocity + axis] = linear_world[axis];
      data->qvel[simulated.base_velocity + 3 + axis] = motion.angular[axis];
    }
    pose[3] = turn.w();
    for (int axis = 0; axis < 3; ++axis) pose[4 + axis] = turn.vec()[axis];
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      data->qpos[simulated.joint_position[i]] = motion.angles[i] = draw(random);
      data->qvel[simulated.joint_velocity[i]] = motion.rates[i] = 5 * draw(random);
    }
    mj_forward(&model, data.get());
    Matrix18 dense;
    mj_fullM(&model, dense.data(), data->qM);
    // Rows and columns in our order and axes.
    Matrix18 order = Matrix18::Zero();
    order.block<3, 3>(simulated.base_velocity, 0) = turn.toRotationMatrix();
    order.block<3, 3>(simulated.base_velocity + 3, 3).setIdentity();
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      order(simulated.joint_velocity[i], static_cast<Eigen::Index>(6 + i)) = 1;
    const Matrix18 mass = order.transpose() * dense * order;
    const Eigen::Matrix<double, kLeggedDofs, 1> bias =
        order.transpose() * Eigen::Map<const Eigen::Matrix<double, kLeggedDofs, 1>>(data->qfrc_bias);
    LeggedEquations ours;
    dynamics.step(motion, ours);
    EXPECT_LE((ours.mass - mass).norm(), 1e-9 * mass.norm()) << trial;
    EXPECT_LE((ours.bias - bias).norm(), 1e-9 * bias.norm()) << trial;
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

}  // namespace
}  // namespace robot_control
