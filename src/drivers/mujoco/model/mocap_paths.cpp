#include "drivers/mujoco/model/mocap_paths.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "drivers/driver.h"

namespace robot_control {
namespace {

constexpr std::string_view kPrefix = "path/";

double length_of(const std::array<double, 2>& from, const std::array<double, 2>& to) {
  return std::hypot(to[0] - from[0], to[1] - from[1]);
}

}  // namespace

MocapPaths::MocapPaths(const mjModel& model) {
  for (int id = 0; id < model.nnumeric; ++id) {
    const std::string name = mj_id2name(&model, mjOBJ_NUMERIC, id);
    if (!name.starts_with(kPrefix)) continue;
    const int body = mj_name2id(&model, mjOBJ_BODY, name.c_str() + kPrefix.size());
    const mjtNum* const data = model.numeric_data + model.numeric_adr[id];
    const int size = model.numeric_size[id];
    Path path{.mocap = body < 0 ? -1 : model.body_mocapid[body], .speed = data[0], .length = 0, .corners = {}};
    for (int i = 1; i + 1 < size; i += 2) path.corners.push_back({data[i], data[i + 1]});
    for (std::size_t i = 0; i < path.corners.size(); ++i)
      path.length += length_of(path.corners[i], path.corners[(i + 1) % path.corners.size()]);
    if (path.mocap < 0 || size % 2 == 0 || !(path.length > 0) || !std::isfinite(path.length + path.speed)) {
      throw DriverError("<numeric name=\"" + name +
                        "\">: there is no such path. Name a body with mocap=\"true\" behind \"" + std::string(kPrefix) +
                        "\", and give a speed and at least two corners x y.");
    }
    paths_.push_back(std::move(path));
  }
}

void MocapPaths::place(double time, mjData& data) const noexcept {
  for (const Path& path : paths_) {
    double travelled = std::fmod(path.speed * time, path.length);
    if (travelled < 0) travelled += path.length;
    std::size_t from = 0, to = 1;
    for (;; from = to, to = (to + 1) % path.corners.size()) {
      const double side = length_of(path.corners[from], path.corners[to]);
      if (travelled <= side || to == 0) {
        const double part = side > 0 ? std::min(travelled / side, 1.0) : 0;
        for (std::size_t axis = 0; axis < 2; ++axis)
          data.mocap_pos[3 * static_cast<std::size_t>(path.mocap) + axis] =
              path.corners[from][axis] + part * (path.corners[to][axis] - path.corners[from][axis]);
        break;
      }
      travelled -= side;
    }
  }
}

}  // namespace robot_control
