#pragma once
/// The path of a foot in the air, in the part 0 … 1 of its swing. With b(s) = s² (3 − 2 s), the foot goes
///
///   over ground   from a to b:  a + b(s) (b − a)
///   height        in the first half up to the top with b(2 s), in the second half down with b(2 s − 1)
///
/// So it leaves and meets the ground without speed. For a swing of T seconds, its acceleration is at most 6/T² of its
/// way over ground, and 24/T² of its lift.

#include <Eigen/Core>
#include <algorithm>

namespace robot_control {

/// m, m/s, m/s².
struct SwingPoint {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
};

/// `top` is the height of the middle, `time` that of the swing in s.
inline SwingPoint swing_point(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double top, double part,
                              double time) noexcept {
  SwingPoint point;
  const auto go = [&point](Eigen::Index axis, double a, double b, double s, double duration) {
    point.place[axis] = a + s * s * (3 - 2 * s) * (b - a);
    point.velocity[axis] = 6 * s * (1 - s) * (b - a) / duration;
    point.acceleration[axis] = (6 - 12 * s) * (b - a) / (duration * duration);
  };
  const double s = std::clamp(part, 0.0, 1.0);
  for (Eigen::Index axis = 0; axis < 2; ++axis) go(axis, from[axis], to[axis], s, time);
  if (s < 0.5) {
    go(2, from.z(), top, 2 * s, time / 2);
  } else {
    go(2, top, to.z(), 2 * s - 1, time / 2);
  }
  return point;
}

}  // namespace robot_control
