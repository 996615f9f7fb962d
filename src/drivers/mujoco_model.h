#pragma once
/// Robot and scene as one compiled MuJoCo model, with the addresses of what the plant reads and writes.
///
/// Solver, cone, integrator and time step are the plant's (Newton, elliptic, impratio 100, Euler); gravity and
/// all else of `<option>` are the scene's. Benchmarks step the same model bare:
///
///   const MujocoModel robot = compile_model(model, parameters, period);
///   const MujocoData data = set_down(robot);
///   mj_step(robot.model.get(), data.get());

#include <mujoco/mujoco.h>

#include <array>
#include <memory>
#include <vector>

#include "drivers/mujoco_plant_parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// A MuJoCo step is at most this long, s: the contact's time constant of 4 ms (mjcf.h) needs four steps.
inline constexpr double kLongestStep = 0.001;

struct DeleteMujoco {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};
using MujocoData = std::unique_ptr<mjData, DeleteMujoco>;

struct MujocoModel {
  std::unique_ptr<mjModel, DeleteMujoco> model;
  int substeps = 1;  ///< per period: ⌈period / 1 ms⌉
  int base_body = 0;
  int base_position = 0;             ///< into qpos: x y z, quaternion w x y z
  int base_velocity = 0;             ///< into qvel: linear in world axes, angular in base axes
  std::vector<int> joint_position;   ///< into qpos, per joint of RobotModel
  std::vector<int> joint_velocity;   ///< into qvel, qfrc_applied
  std::array<int, 2> wheel_shape{};  ///< geoms, left and right
  int gyro = 0;                      ///< into sensordata
  int accelerometer = 0;             ///< into sensordata
  std::array<double, 7> start{};     ///< qpos of the base where the robot is set down
};

/// Throws DriverError: a scene that does not compile (with MuJoCo's own message), has no site `start` or changes the
/// robot's mass; shapes that cannot be simulated. `period` in s.
MujocoModel compile_model(const RobotModel& robot, const MujocoPlantParameters& parameters, double period);

/// Fresh data, the robot at its start pose, at rest, not yet settled.
MujocoData set_down(const MujocoModel& robot);

}  // namespace robot_control
