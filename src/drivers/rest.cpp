#include "drivers/rest.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr double kFallen = 30 * M_PI / 180;

}  // namespace

bool at_rest(const MujocoModel& model, const mjData& data, double base_speed, double joint_speed) noexcept {
  const mjtNum* base = data.qvel + model.base_velocity;
  return std::all_of(base, base + 6, [&](double speed) { return std::abs(speed) < base_speed; }) &&
         std::all_of(model.joint_velocity.begin(), model.joint_velocity.end(),
                     [&](int joint) { return std::abs(data.qvel[joint]) < joint_speed; });
}

bool fallen(const MujocoModel& model, const mjData& data) noexcept {
  const mjtNum upright[3] = {0, 0, 1};
  mjtNum up[3];
  mju_rotVecQuat(up, upright, data.qpos + model.base_position + 3);
  return mju_dot3(up, model.up.data()) < std::cos(kFallen);
}

}  // namespace robot_control
