#pragma once
/// compile_model compiles robot and scene as one MuJoCo model, with the addresses of all values that the plant reads
/// and writes.
///
/// The plant sets solver, cone, integrator and time step (Newton, elliptic, impratio 100, Euler). Gravity and the rest
/// of `<option>` are those of the scene. `slope` rotates gravity about an axis of the x-y plane of the site `start`.
/// The world rises along its x, or `slope_heading` from it. `terrain` lies on this plane (terrain.h). The robot's
/// lowest collision point, with the joints at JointModel::rest_position, is on the plane or the terrain.
///
/// A benchmark runs a minimal loop as follows; with native friction, mj_step alone is enough:
///
///   const MujocoModel robot = compile_model(model, parameters, period);
///   const MujocoData data = set_down(robot);
///   WheelContacts wheels(robot, parameters);
///   mj_step1 → wheels.observe → wheels.apply → mj_step2 → wheels.weigh; the caller clears qfrc_applied

#include <mujoco/mujoco.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "drivers/mujoco/model/true_robot.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"

namespace robot_control {

/// A MuJoCo step has at most this length in s: the contact's time constant of 4 ms (mjcf.h) needs four steps.
inline constexpr double kMaxStep = 0.001;

inline constexpr int kRobotGroup = 5;  ///< geom group of all shapes of the robot

struct DeleteMujoco {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};
using MujocoData = std::unique_ptr<mjData, DeleteMujoco>;

struct MujocoModel {
  std::shared_ptr<mjModel> model;  ///< not changed after compile_model, so that copies share it
  TrueRobot robot;
  int substeps = 1;  ///< steps per period: ⌈period / 1 ms⌉
  int base_body = 0;
  int base_position = 0;              ///< index into qpos: x y z, quaternion w x y z
  int base_velocity = 0;              ///< index into qvel: linear in world axes, angular in base axes
  std::vector<int> joint_position;    ///< indices into qpos, per joint of the robot
  std::vector<int> joint_velocity;    ///< indices into qvel and qfrc_applied
  std::vector<int> wheel_shape;       ///< geoms of TrueRobot::wheels
  std::vector<std::size_t> actuated;  ///< joints with a motor: driven and held ones
  std::array<double, 3> up{0, 0, 1};  ///< z axis of the site `start`, world axes
  int gyro = 0;                       ///< index into sensordata
  int imu = 0;                        ///< site
};

/// Compiles the model; `period` is in s. The robot's shapes are in geom group kRobotGroup. Throws DriverError if the
/// scene does not compile (with MuJoCo's message), has no site `start` or changes the robot's mass. Throws RobotError
/// as true_robot does.
MujocoModel compile_model(const MachineModel& robot, const MujocoPlantParameters& parameters, double period);

/// Returns new data with the robot at its start pose and speed zero, before it settles.
MujocoData set_down(const MujocoModel& robot);

/// Returns robot and scene as one self-contained MJCF text for `mujoco-simulate`. That program has no other friction
/// than the native one, and no brakes: dry friction of its effort limit holds a held joint. Files that the scene loads
/// (textures, meshes) keep their names. Throws as compile_model does.
std::string exported_mjcf(const MachineModel& robot, const MujocoPlantParameters& parameters, double period);

}  // namespace robot_control
