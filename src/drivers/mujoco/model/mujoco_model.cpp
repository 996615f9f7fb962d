#include "drivers/mujoco/model/mujoco_model.h"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <system_error>

#include "drivers/driver.h"
#include "drivers/mujoco/model/mjcf.h"
#include "drivers/mujoco/model/terrain.h"
#include "drivers/mujoco/mujoco_errors.h"
#include "files/given_path.h"
#include "files/input_file.h"
#include "files/message_text.h"
#include "machine/bodies/posed_bodies.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

constexpr std::string_view kXmlBlank = " \t\r\n";

/// Returns the values of all attributes `name="…"` in the text.
std::vector<std::string> attribute_values(std::string_view text, std::string_view name) {
  std::vector<std::string> values;
  for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    if (at == 0 || kXmlBlank.find(text[at - 1]) == std::string_view::npos) continue;
    std::size_t next = text.find_first_not_of(kXmlBlank, at + name.size());
    if (next == std::string_view::npos || text[next] != '=') continue;
    next = text.find_first_not_of(kXmlBlank, next + 1);
    if (next == std::string_view::npos || (text[next] != '"' && text[next] != '\'')) continue;
    const std::size_t end = text.find(text[next], next + 1);
    if (end == std::string_view::npos) continue;
    values.emplace_back(text.substr(next + 1, end - next - 1));
  }
  return values;
}

class SceneFiles {
 public:
  explicit SceneFiles(const std::filesystem::path& scene) : folder_(scene.parent_path()), folders_{""} { read(scene); }

 private:
  [[noreturn]] static void refuse_scene(const std::filesystem::path& path, const std::string& problem) {
    throw DriverError(fit_for_message(file_error(path.string(), problem)) +
                      ". Set mujoco_plant.scene to an MJCF file whose files are regular ones.");
  }

  void read(const std::filesystem::path& path) {
    if (!seen_.insert(path).second) return;
    const InputFile file = read_input_file(path, kMaxDescription);
    if (!file.problem.empty()) refuse_scene(path, file.problem);
    for (const std::string_view name : {"meshdir", "texturedir", "assetdir"}) {
      for (const std::string& folder : attribute_values(file.text, name)) folders_.insert(folder);
    }
    for (const std::string& name : attribute_values(file.text, "file")) {
      for (const std::filesystem::path& folder : folders_) look_at(folder_ / folder / name);
    }
  }

  void look_at(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return;
    const std::string problem = input_file_problem(path, kMaxDescription);
    if (!problem.empty()) refuse_scene(path, problem);
    if (path.extension() == ".xml" || path.extension() == ".mjcf") read(path);
  }

  std::filesystem::path folder_;
  std::set<std::filesystem::path> folders_;  ///< folders for assets, relative to the scene's folder
  std::set<std::filesystem::path> seen_;
};

/// Checks the files of a scene before MuJoCo opens them: the MJCF itself and every file that an attribute `file` names.
/// It also searches included files, and the folders of `meshdir`, `texturedir` and `assetdir` beside the scene's
/// folder. Throws DriverError if the scene or an existing file that it names is not a regular file of at most
/// kMaxDescription bytes. MuJoCo itself reports missing files.
void check_scene_files(const std::string& scene) {
  SceneFiles{scene};
}

using ModelPointer = std::unique_ptr<mjModel, DeleteMujoco>;

bool add_file(mjVFS& files, const std::string& name, const std::string& text) {
  const int size = static_cast<int>(text.size());
#if mjVERSION_HEADER >= 316
  return mj_addBufferVFS(&files, name.c_str(), text.data(), size) == 0;
#else
  if (mj_makeEmptyFileVFS(&files, name.c_str(), size) != 0) return false;
  std::memcpy(files.filedata[mj_findFileVFS(&files, name.c_str())], text.data(), text.size());
  return true;
#endif
}

class VirtualFiles {
 public:
  VirtualFiles() : files_(std::make_unique<mjVFS>()) { mj_defaultVFS(files_.get()); }
  ~VirtualFiles() { mj_deleteVFS(files_.get()); }
  VirtualFiles(const VirtualFiles&) = delete;
  VirtualFiles& operator=(const VirtualFiles&) = delete;

  void add(const std::string& name, const std::string& text) {
    if (!add_file(*files_, name, text)) throw DriverError(name + ": MuJoCo takes no such file name.");
  }
  const mjVFS* get() const { return files_.get(); }

 private:
  std::unique_ptr<mjVFS> files_;
};

ModelPointer load(const std::string& path, const mjVFS* files, const std::string& blamed) {
  std::array<char, 1000> error{};
  ModelPointer model(mj_loadXML(path.c_str(), files, error.data(), static_cast<int>(error.size())));
  if (!model) {
    throw DriverError(blamed + ": MuJoCo does not compile it: " + fit_for_message(on_one_line(error.data())) +
                      ". Repair the scene, or set another one (mujoco_plant.scene).");
  }
  return model;
}

int find(const mjModel& model, mjtObj type, const std::string& name) {
  return mj_name2id(&model, type, name.c_str());
}

MjcfPlace place_of(const mjModel& scene, const std::filesystem::path& path, const Terrain& terrain, double height) {
  const int site = find(scene, mjOBJ_SITE, kMjcfStart);
  if (site < 0) {
    throw DriverError(
        path.string() +
        ": there is no site \"start\". Add <site name=\"start\" pos=\"…\"/> where the robot is set down.");
  }
  const MujocoData data(mj_makeData(&scene));
  mj_kinematics(&scene, data.get());
  const mjtNum* matrix = data->site_xmat + 9 * site;
  MjcfPlace place;
  place.scene_file = path.filename().string();
  mju_copy3(place.pose.data(), data->site_xpos + 3 * site);
  mju_mat2Quat(place.pose.data() + 3, matrix);
  place.terrain = terrain.mjcf(place.pose);
  const double above = height + terrain.start_height();
  for (int axis = 0; axis < 3; ++axis) place.pose[static_cast<std::size_t>(axis)] += above * matrix[3 * axis + 2];
  return place;
}

void check_mass(const MujocoModel& robot, const std::string& path) {
  const double simulated = robot.model->body_subtreemass[robot.base_body];
  if (std::abs(simulated - robot.robot.mass) <= 1e-9 * robot.robot.mass) return;
  throw DriverError(path + ": it makes the robot weigh " + std::to_string(simulated) + " kg instead of " +
                    std::to_string(robot.robot.mass) +
                    " kg. Remove settotalmass, boundmass or inertiafromgeom from its <compiler>.");
}

// Sets the options of the plant; `start` is the pose of the base at its start.
void set_options(mjModel& model, double timestep, const MujocoPlantParameters& parameters,
                 const std::array<double, 7>& start) {
  model.opt.timestep = timestep;
  model.opt.integrator = mjINT_EULER;
  model.opt.solver = mjSOL_NEWTON;
  model.opt.cone = mjCONE_ELLIPTIC;
  model.opt.impratio = 100;
  if (parameters.slope == 0) return;
  const mjtNum lateral[3] = {-std::sin(parameters.slope_heading), std::cos(parameters.slope_heading), 0};
  mjtNum axis[3], turn[4];
  mju_rotVecQuat(axis, lateral, start.data() + 3);
  mju_axisAngle2Quat(turn, axis, parameters.slope);
  const mjtNum level[3] = {model.opt.gravity[0], model.opt.gravity[1], model.opt.gravity[2]};
  mju_rotVecQuat(model.opt.gravity, level, turn);
}

void find_addresses(MujocoModel& result) {
  const mjModel& model = *result.model;
  const TrueRobot& robot = result.robot;
  result.base_body = find(model, mjOBJ_BODY, mjcf_body_name(robot.base_link));
  const int base_joint = model.body_jntadr[result.base_body];
  result.base_position = model.jnt_qposadr[base_joint];
  result.base_velocity = model.jnt_dofadr[base_joint];
  for (const JointModel& joint : robot.joints) {
    const int id = find(model, mjOBJ_JOINT, joint.name);
    result.joint_position.push_back(model.jnt_qposadr[id]);
    result.joint_velocity.push_back(model.jnt_dofadr[id]);
  }
  result.actuated = actuated_joint_indices(robot);
  for (std::size_t wheel = 0; wheel < robot.wheels.size(); ++wheel) {
    result.wheel_shape.push_back(find(model, mjOBJ_GEOM, mjcf_wheel_name(wheel)));
  }
  result.gyro = model.sensor_adr[find(model, mjOBJ_SENSOR, kMjcfGyro)];
  result.imu = find(model, mjOBJ_SITE, kMjcfImu);
}

/// Returns the height of the root frame above the ground while every joint rests, m.
double standing_height(const TrueRobot& robot) {
  const RigidBodies at_rest = resting(*robot.bodies, robot.joints);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < at_rest.bodies.size(); ++i) {
    const RigidBody &body = at_rest.bodies[i], &at_zero = robot.bodies->bodies[i];
    const TrueWheel* const wheel = wheel_of(robot, body);
    RollingEllipsoid shape = wheel == nullptr ? RollingEllipsoid{} : wheel->shape;
    if (body.in_root.matrix() != at_zero.in_root.matrix()) {
      Eigen::Map<Eigen::Vector3d> centre(shape.centre_base.data());
      centre = body.in_root * (at_zero.in_root.inverse() * Eigen::Vector3d(centre));
    }
    std::ranges::copy(shape_points(body, wheel == nullptr ? nullptr : &shape), std::back_inserter(points));
  }
  return height_above(points);
}

/// Returns ", such as flat, kerb in its folder"; "" if there is no other scene.
std::string scenes_beside(const std::filesystem::path& scene) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(scene.parent_path(), error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() == ".xml") names.push_back(entry->path().stem());
  }
  std::sort(names.begin(), names.end());
  return names.empty() ? "" : ", such as " + printable(list(names)) + " in its folder";
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

namespace {

/// `at_rest`: the joints' references are their rest positions, in which a viewer opens the model.
MujocoModel compiled(const MachineModel& robot, const MujocoPlantParameters& parameters, double period, bool at_rest) {
  install_mujoco_handlers();
  const std::filesystem::path scene = parameters.scene;
  if (std::error_code error; !std::filesystem::exists(scene, error)) {
    throw DriverError(fit_for_message(file_error(scene.string(), failed("read", ENOENT))) +
                      ". Set mujoco_plant.scene to the path of an MJCF file" + scenes_beside(scene) + ".");
  }
  check_scene_files(scene);
  MujocoModel result;
  result.substeps = static_cast<int>(std::ceil(period / kMaxStep - 1e-9));
  const double step = period / result.substeps;
  result.robot = true_robot(robot, parameters, step);
  MjcfPlace place = place_of(*load(scene.string(), nullptr, scene.string()), scene,
                             Terrain(parameters.terrain, parameters.seed), standing_height(result.robot));

  place.at_rest = at_rest;
  const std::string name = scene.stem().string() + "+robot.xml";
  VirtualFiles files;
  files.add(name, robot_mjcf(result.robot, parameters, place));
  // The text is loaded in the scene's directory, so that relative paths in the scene stay valid.
  result.model = load((scene.parent_path() / name).string(), files.get(), robot.source + " in scene " + scene.string());
  set_options(*result.model, step, parameters, place.pose);
  apply_angles(result.robot, *result.model);
  find_addresses(result);
  for (std::size_t joint = 0; at_rest && joint < result.robot.joints.size(); ++joint)
    result.model->qpos0[result.joint_position[joint]] = result.robot.joints[joint].rest_position;
  for (int shape = 0; shape < result.model->ngeom; ++shape) {
    if (result.model->body_rootid[result.model->geom_bodyid[shape]] == result.base_body)
      result.model->geom_group[shape] = kRobotGroup;
  }
  check_mass(result, scene.string());
  const mjtNum up[3] = {0, 0, 1};
  mju_rotVecQuat(result.up.data(), up, place.pose.data() + 3);
  return result;
}

}  // namespace

MujocoModel compile_model(const MachineModel& robot, const MujocoPlantParameters& parameters, double period) {
  return compiled(robot, parameters, period, false);
}

MujocoData set_down(const MujocoModel& robot) {
  MujocoData data(mj_makeData(robot.model.get()));
  for (std::size_t joint = 0; joint < robot.robot.joints.size(); ++joint)
    data->qpos[robot.joint_position[joint]] = robot.robot.joints[joint].rest_position;
  return data;
}

std::string exported_mjcf(const MachineModel& robot, const MujocoPlantParameters& parameters, double period) {
  MujocoPlantParameters native = parameters;
  native.tyre = TyreModel::kNative;
  const MujocoModel whole = compiled(robot, native, period, true);
  for (const std::size_t joint : whole.actuated) {
    const JointModel& held = whole.robot.joints[joint];
    if (held.role != JointRole::kHeld) continue;
    mjtNum& friction = whole.model->dof_frictionloss[whole.joint_velocity[joint]];
    friction = std::max(friction, std::min(held.effort_limit, kMaxPlausible));
  }
  std::string path = (std::filesystem::temp_directory_path() / "robot_control_XXXXXX").string();
  const int file = mkstemp(path.data());
  if (file < 0) throw DriverError(path + ": cannot be created: " + std::strerror(errno));
  close(file);
  std::array<char, 1000> error{};
  const bool saved = mj_saveLastXML(path.c_str(), whole.model.get(), error.data(), error.size()) != 0;
  std::string text = read_file(path);
  std::filesystem::remove(path);
  if (!saved) throw DriverError(robot.source + ": MuJoCo does not write it: " + error.data());
  return text;
}

}  // namespace robot_control
