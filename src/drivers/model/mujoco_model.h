#pragma once
/// Robot and scene as one compiled MuJoCo model, with the addresses of what the plant reads and writes.
///
/// Solver, cone, integrator and time step are the plant's (Newton, elliptic, impratio 100, Euler); gravity and all
/// else of `<option>` are the scene's. `slope` turns gravity about the y axis of the site `start`: the world climbs
/// along its x. The robot stands with its lowest collision point on the site's x-y plane.
///
/// A bare loop, for benchmarks:
///
///   const MujocoModel robot = compile_model(model, parameters, period);
///   const MujocoData data = set_down(robot);
///   WheelContacts wheels(robot, parameters);
///   mj_step1 → wheels.observe → wheels.apply → mj_step2 → wheels.weigh; qfrc_applied is the caller's to clear
///
/// and with native friction just mj_step.

#include <mujoco/mujoco.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "drivers/mujoco_plant_parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// A MuJoCo step is at most this long, s: the contact's time constant of 4 ms (mjcf.h) needs four steps.
inline constexpr double kMaxStep = 0.001;

struct DeleteMujoco {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};
using MujocoData = std::unique_ptr<mjData, DeleteMujoco>;

struct MujocoModel {
  std::unique_ptr<mjModel, DeleteMujoco> model;
  RobotModel robot;  ///< the true one (true_robot.h)
  int substeps = 1;  ///< per period: ⌈period / 1 ms⌉
  int base_body = 0;
  int base_position = 0;            ///< into qpos: x y z, quaternion w x y z
  int base_velocity = 0;            ///< into qvel: linear in world axes, angular in base axes
  std::vector<int> joint_position;  ///< into qpos, per joint of RobotModel
  std::vector<int> joint_velocity;  ///< into qvel, qfrc_applied
  std::vector<int> wheel_shape;     ///< geoms: the drive wheels of RobotModel, then its casters
  std::size_t drive_wheels = 0;
  std::array<double, 3> up{0, 0, 1};  ///< z axis of the site `start`, world axes
  int gyro = 0;                       ///< into sensordata
  int imu = 0;                        ///< site
};

/// Throws DriverError: a scene that does not compile (with MuJoCo's own message), has no site `start` or changes the
/// robot's mass; RobotError as true_robot does. `period` in s.
MujocoModel compile_model(const RobotModel& robot, const MujocoPlantParameters& parameters, double period);

/// Fresh data, the robot at its start pose, at rest, not yet settled.
MujocoData set_down(const MujocoModel& robot);

/// Robot and scene as one self-contained MJCF text, as `mujoco-simulate` opens it; with native friction, the only
/// one that it has. Files that the scene loads (textures, meshes) keep their names. Throws as compile_model.
std::string exported_mjcf(const RobotModel& robot, const MujocoPlantParameters& parameters, double period);

}  // namespace robot_control
