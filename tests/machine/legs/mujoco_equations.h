#pragma once
/// MuJoCo is the oracle of the equations of motion. Its velocities of the base are linear in world axes and angular in
/// the base's.

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <stdexcept>

#include "drivers/mujoco/model/mujoco_model.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/leg_dynamics.h"

namespace robot_control {

/// Relative to the norms of MuJoCo's mass matrix and bias.
struct EquationsDifference {
  double mass = 0;
  double bias = 0;
};

/// MuJoCo turns inertias to their principal axes only within 10⁻⁸; these are exact.
inline void set_exact_inertias(const LegModel& robot, mjModel& model) {
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

/// Returns the largest differences in `states` random states. Throws std::runtime_error if MuJoCo's model of the robot
/// has another number of degrees of freedom.
inline EquationsDifference difference_from_mujoco(const LegModel& robot, int states) {
  using Matrix = Eigen::Matrix<double, kLeggedDofs, kLeggedDofs, Eigen::RowMajor>;
  using Vector = Eigen::Matrix<double, kLeggedDofs, 1>;
  MujocoPlantParameters parameters;
  parameters.scene = PROJECT_DIRECTORY "/urdf/scenes/flat.xml";
  const MujocoModel simulated = compile_model(robot, parameters, 0.001);
  mjModel& model = *simulated.model;
  if (model.nv != kLeggedDofs) throw std::runtime_error("MuJoCo's model does not have 18 degrees of freedom");
  for (const int dof : simulated.joint_velocity) model.dof_armature[dof] = robot.rotor_inertia;
  set_exact_inertias(robot, model);
  const MujocoData data = set_down(simulated);
  const LegDynamics dynamics(robot);
  std::mt19937_64 random(31);
  std::normal_distribution<double> draw;
  EquationsDifference worst;
  for (int state = 0; state < states; ++state) {
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
    Matrix dense;
    mj_fullM(&model, dense.data(), data->qM);
    // Rows and columns in our order and axes.
    Matrix order = Matrix::Zero();
    order.block<3, 3>(simulated.base_velocity, 0) = turn.toRotationMatrix();
    order.block<3, 3>(simulated.base_velocity + 3, 3).setIdentity();
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      order(simulated.joint_velocity[i], static_cast<Eigen::Index>(6 + i)) = 1;
    const Matrix mass = order.transpose() * dense * order;
    const Vector bias = order.transpose() * Eigen::Map<const Vector>(data->qfrc_bias);
    LeggedEquations ours;
    dynamics.step(motion, ours);
    worst.mass = std::max(worst.mass, (ours.mass - mass).norm() / mass.norm());
    worst.bias = std::max(worst.bias, (ours.bias - bias).norm() / bias.norm());
  }
  return worst;
}

}  // namespace robot_control
