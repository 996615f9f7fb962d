#include "drivers/mujoco/contact/rest.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "drivers/mujoco/model/mjcf.h"
#include "machine/description/wording.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kFallen = 30 * M_PI / 180;
constexpr double kMinLoad = 0.001;
constexpr double kMinShare = 0.01;

/// Returns the link of a geom. The shapes of a body are in the MJCF in the body's order (mjcf.cpp); a rolling body has
/// a single shape.
std::string link_of(const MujocoModel& model, int geom) {
  const int body = model.model->geom_bodyid[geom];
  std::string name = mj_id2name(model.model.get(), mjOBJ_BODY, body);
  const auto number = static_cast<std::size_t>(geom - model.model->body_geomadr[body]);
  for (const RigidBody& candidate : model.robot.bodies->bodies) {
    const bool slides = wheel_of(model.robot, candidate) == nullptr && number < candidate.shapes.size();
    if (slides && mjcf_body_name(candidate.name) == name) return candidate.shapes[number].link;
  }
  return name;
}

}  // namespace

bool at_rest(const MujocoModel& model, const mjData& data, double base_speed, double joint_speed) noexcept {
  const mjtNum* base = data.qvel + model.base_velocity;
  return std::all_of(base, base + 6, [&](double speed) { return std::abs(speed) < base_speed; }) &&
         std::all_of(model.joint_velocity.begin(), model.joint_velocity.end(),
                     [&](int joint) { return std::abs(data.qvel[joint]) < joint_speed; });
}

std::vector<std::string> moving_joints(const MujocoModel& model, const mjData& data, double joint_speed) {
  std::vector<std::string> names;
  for (std::size_t joint = 0; joint < model.joint_velocity.size(); ++joint) {
    const bool driven = model.robot.joints[joint].role == JointRole::kDriven;
    if (!driven && std::abs(data.qvel[model.joint_velocity[joint]]) >= joint_speed)
      names.push_back(model.robot.joints[joint].name);
  }
  return names;
}

std::string unloaded_side(const MujocoModel& model, const WheelContacts& wheels) {
  const TrueRobot& robot = model.robot;
  if (robot.drive_wheels == 0) return "";
  for (std::size_t side = 0; side < robot.groups.size(); ++side) {
    double load = 0;
    for (std::size_t i = 0; i < robot.drive_wheels; ++i) {
      if (robot.wheels[i].side == side) load += wheels.normal_force(i);
    }
    if (load < kMinLoad * robot.mass * kGravity) return robot.groups[side].name;
  }
  return "";
}

std::string unloaded_wheels(const MujocoModel& model, const WheelContacts& wheels) {
  const double share = model.robot.mass * kGravity / static_cast<double>(model.robot.drive_wheels);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.robot.drive_wheels; ++i) {
    if (wheels.normal_force(i) < kMinShare * share) names.push_back(model.robot.joints[i].name);
  }
  return names.empty() ? "" : list(names);
}

std::string links_on_ground(const MujocoModel& model, const mjData& data) {
  std::set<std::string> names;
  const auto drive_wheels_end = model.wheel_shape.begin() + static_cast<std::ptrdiff_t>(model.robot.drive_wheels);
  for (int i = 0; i < data.ncon; ++i) {
    for (const int geom : {data.contact[i].geom1, data.contact[i].geom2}) {
      const bool of_robot = model.model->body_rootid[model.model->geom_bodyid[geom]] == model.base_body;
      const bool drives = std::find(model.wheel_shape.begin(), drive_wheels_end, geom) != drive_wheels_end;
      if (of_robot && !drives) names.insert(link_of(model, geom));
    }
  }
  return names.empty() ? "" : list({names.begin(), names.end()});
}

bool fallen(const MujocoModel& model, const mjData& data) noexcept {
  const mjtNum upright[3] = {0, 0, 1};
  mjtNum up[3];
  mju_rotVecQuat(up, upright, data.qpos + model.base_position + 3);
  return mju_dot3(up, model.up.data()) < std::cos(kFallen);
}

}  // namespace robot_control
