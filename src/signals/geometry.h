#pragma once
/// These are plain geometric values; the laws use Eigen for algebra.

#include <array>
#include <cmath>

namespace robot_control {

using Vector3 = std::array<double, 3>;     ///< x, y, z
using Quaternion = std::array<double, 4>;  ///< x, y, z, w (the order of geometry_msgs); unit norm
using Matrix6 = std::array<double, 36>;    ///< row-major over x, y, z, roll, pitch, yaw

inline bool finite(const Vector3& vector) noexcept {
  return std::isfinite(vector[0]) && std::isfinite(vector[1]) && std::isfinite(vector[2]);
}

struct Pose {
  Vector3 position{};                  ///< m
  Quaternion orientation{0, 0, 0, 1};  ///< rotates from the child's axes to the parent's
};

struct Twist {
  Vector3 linear{};   ///< m/s
  Vector3 angular{};  ///< rad/s
};

inline bool finite(const Twist& twist) noexcept {
  return finite(twist.linear) && finite(twist.angular);
}

inline bool zero(const Vector3& vector) noexcept {
  return vector[0] == 0 && vector[1] == 0 && vector[2] == 0;
}

inline bool zero(const Twist& twist) noexcept {
  return zero(twist.linear) && zero(twist.angular);
}

}  // namespace robot_control
