#include "drivers/rest.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "description/wording.h"
#include "robot/gravity.h"

namespace robot_control {
namespace {

constexpr double kFallen = 30 * M_PI / 180;
constexpr double kLeastLoad = 0.001;

}  // namespace

bool at_rest(const MujocoModel& model, const mjData& data, double base_speed, double joint_speed) noexcept {
  const mjtNum* base = data.qvel + model.base_velocity;
  return std::all_of(base, base + 6, [&](double speed) { return std::abs(speed) < base_speed; }) &&
         std::all_of(model.joint_velocity.begin(), model.joint_velocity.end(),
                     [&](int joint) { return std::abs(data.qvel[joint]) < joint_speed; });
}

std::string unloaded_side(const MujocoModel& model, const WheelContacts& wheels) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    double load = 0;
    for (std::size_t i = 0; i < model.drive_wheels; ++i) {
      if (model.robot.wheels[i].side == side) load += wheels.normal_force(i);
    }
    if (load < kLeastLoad * model.robot.mass * kGravity) return side == Side::kLeft ? "left" : "right";
  }
  return "";
}

std::string bodies_on_ground(const MujocoModel& model, const mjData& data) {
  std::set<std::string> names;
  for (int i = 0; i < data.ncon; ++i) {
    for (const int shape : {data.contact[i].geom1, data.contact[i].geom2}) {
      const int body = model.model->geom_bodyid[shape];
      const bool of_robot = model.model->body_rootid[body] == model.base_body;
      const auto& rolling = model.wheel_shape;
      if (!of_robot || std::find(rolling.begin(), rolling.end(), shape) != rolling.end()) continue;
      names.insert(mj_id2name(model.model.get(), mjOBJ_BODY, body));
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
