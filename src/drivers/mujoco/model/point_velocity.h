#pragma once
/// The velocity of a point that moves with a body.

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>

namespace robot_control {

/// Returns the velocity in m/s, world axes. MuJoCo's cvel has the angular, then the linear velocity at the centre of
/// mass of the body's whole tree.
inline Eigen::Vector3d point_velocity(const mjModel& model, const mjData& data, int body,
                                      const mjtNum* point) noexcept {
  using Vector = Eigen::Map<const Eigen::Vector3d>;
  const Vector angular(data.cvel + 6 * body), linear(data.cvel + 6 * body + 3);
  const Vector centre(data.subtree_com + 3 * model.body_rootid[body]);
  return linear + angular.cross(Vector(point) - centre);
}

}  // namespace robot_control
