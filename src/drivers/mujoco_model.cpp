#include "drivers/mujoco_model.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>

#include "drivers/mjcf.h"
#include "drivers/mujoco_errors.h"
#include "hal/driver.h"
#include "robot/rigid_bodies.h"

namespace robot_control {
namespace {

using ModelPointer = std::unique_ptr<mjModel, DeleteMujoco>;

class VirtualFiles {
 public:
  VirtualFiles() : files_(std::make_unique<mjVFS>()) { mj_defaultVFS(files_.get()); }
  ~VirtualFiles() { mj_deleteVFS(files_.get()); }
  VirtualFiles(const VirtualFiles&) = delete;
  VirtualFiles& operator=(const VirtualFiles&) = delete;

  void add(const std::string& name, const std::string& text) {
    if (mj_makeEmptyFileVFS(files_.get(), name.c_str(), static_cast<int>(text.size())) != 0) {
      throw DriverError(name + ": MuJoCo takes no such file name.");
    }
    std::memcpy(files_->filedata[mj_findFileVFS(files_.get(), name.c_str())], text.data(), text.size());
  }
  const mjVFS* get() const { return files_.get(); }

 private:
  std::unique_ptr<mjVFS> files_;
};

ModelPointer load(const std::string& path, const mjVFS* files, const std::string& blamed) {
  std::array<char, 1000> error{};
  ModelPointer model(mj_loadXML(path.c_str(), files, error.data(), static_cast<int>(error.size())));
  mj_freeLastXML();
  if (!model) throw DriverError(blamed + ": MuJoCo does not compile it: " + error.data());
  return model;
}

int find(const mjModel& model, mjtObj type, const std::string& name) {
  return mj_name2id(&model, type, name.c_str());
}

void check_start(const mjModel& scene, const std::string& path) {
  if (find(scene, mjOBJ_SITE, kMjcfStart) >= 0) return;
  throw DriverError(path +
                    ": there is no site \"start\". Add <site name=\"start\" pos=\"…\"/> where the robot is set down.");
}

void check_mass(const MujocoModel& robot, double mass, const std::string& path) {
  const double simulated = robot.model->body_subtreemass[robot.base_body];
  if (std::abs(simulated - mass) <= 1e-9 * mass) return;
  throw DriverError(path + ": it makes the robot weigh " + std::to_string(simulated) + " kg instead of " +
                    std::to_string(mass) +
                    " kg. Remove settotalmass, boundmass or inertiafromgeom from its <compiler>.");
}

void set_options(mjModel& model, double timestep) {
  model.opt.timestep = timestep;
  model.opt.integrator = mjINT_EULER;
  model.opt.solver = mjSOL_NEWTON;
  model.opt.cone = mjCONE_ELLIPTIC;
  model.opt.impratio = 100;
}

void find_addresses(const RigidBodies& bodies, const RobotModel& robot, MujocoModel& result) {
  mjModel& model = *result.model;
  result.base_body = find(model, mjOBJ_BODY, robot.base_link);
  const int base_joint = model.body_jntadr[result.base_body];
  result.base_position = model.jnt_qposadr[base_joint];
  result.base_velocity = model.jnt_dofadr[base_joint];
  for (const JointModel& joint : robot.joints) {
    const int id = find(model, mjOBJ_JOINT, joint.name);
    result.joint_position.push_back(model.jnt_qposadr[id]);
    result.joint_velocity.push_back(model.jnt_dofadr[id]);
    const BodyJoint& described = bodies.moved_by(joint.name)->joint;
    if (model.jnt_limited[id]) {
      model.jnt_range[2 * id] = described.lower;
      model.jnt_range[2 * id + 1] = described.upper;
    }
  }
  for (std::size_t wheel = 0; wheel < 2; ++wheel) {
    result.wheel_shape[wheel] = find(model, mjOBJ_GEOM, mjcf_wheel_name(wheel));
  }
  result.gyro = model.sensor_adr[find(model, mjOBJ_SENSOR, kMjcfGyro)];
  result.accelerometer = model.sensor_adr[find(model, mjOBJ_SENSOR, kMjcfAccelerometer)];
}

std::array<double, 7> start_pose(const mjModel& model, double height) {
  const MujocoData data(mj_makeData(&model));
  mj_kinematics(&model, data.get());
  const int site = find(model, mjOBJ_SITE, kMjcfStart);
  const mjtNum* matrix = data->site_xmat + 9 * site;
  std::array<double, 7> pose{};
  for (int axis = 0; axis < 3; ++axis) {
    pose[static_cast<std::size_t>(axis)] = data->site_xpos[3 * site + axis] + height * matrix[3 * axis + 2];
  }
  mju_mat2Quat(pose.data() + 3, matrix);
  return pose;
}

}  // namespace

MujocoModel compile_model(const RobotModel& robot, const MujocoPlantParameters& parameters, double period) {
  install_mujoco_handlers();
  const std::filesystem::path scene = parameters.scene;
  check_start(*load(scene.string(), nullptr, scene.string()), scene.string());

  const RigidBodies bodies = read_rigid_bodies({robot.urdf, robot.source});
  const std::string name = scene.stem().string() + "+" + robot.base_link + ".xml";
  VirtualFiles files;
  files.add(name, robot_mjcf(bodies, robot, scene.filename().string()));
  MujocoModel result;
  // In the scene's directory, so that its own relative paths stay true.
  result.model = load((scene.parent_path() / name).string(), files.get(), robot.source + " in scene " + scene.string());
  result.substeps = static_cast<int>(std::ceil(period / kLongestStep - 1e-9));
  set_options(*result.model, period / result.substeps);
  find_addresses(bodies, robot, result);
  check_mass(result, robot.mass, scene.string());
  result.start = start_pose(*result.model, standing_height(bodies, robot));
  return result;
}

MujocoData set_down(const MujocoModel& robot) {
  MujocoData data(mj_makeData(robot.model.get()));
  std::copy(robot.start.begin(), robot.start.end(), data->qpos + robot.base_position);
  return data;
}

}  // namespace robot_control
