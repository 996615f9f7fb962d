#pragma once
/// Quaternion → rotation matrix.

#include <Eigen/Geometry>

#include "signals/geometry.h"

namespace robot_control {

/// Turns vectors of the rotated axes into those of the axes that `q` refers to. `q`: x y z w, of any length but 0.
inline Eigen::Matrix3d rotation_of(const Quaternion& q) noexcept {
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

}  // namespace robot_control
