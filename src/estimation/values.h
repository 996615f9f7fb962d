#pragma once
/// Small algebra on plain values, which the estimator's state is made of.

#include <Eigen/Core>

#include "signals/geometry.h"

namespace robot_control {

inline double square(double value) noexcept {
  return value * value;
}
inline Vector3 array(const Eigen::Vector3d& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

}  // namespace robot_control
