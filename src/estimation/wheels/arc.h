#pragma once
/// Motion along an exact circular arc, smooth through zero turn.
///
/// Over one step the base moves with a constant twist in its own axes: by `forward`, `left` [m] and `turn` [rad].
/// Integrating R(yaw) (forward, left) over a yaw that grows evenly by `turn` gives, with h = turn / 2,
///
///   (x, y) = sinc(h) · R(yaw + h) · (forward, left)       sinc(h) = sin(h) / h
///
/// the chord of the arc. REP 103: x forward, y left, turn positive to the left.

#include <cmath>

#include "estimation/values.h"

namespace robot_control {

struct Motion {
  double forward = 0;  ///< m
  double left = 0;     ///< m
  double turn = 0;     ///< rad
};

inline double sinc(double h) noexcept {
  return h == 0 ? 1 : std::sin(h) / h;
}

/// m, in the axes that `yaw` is measured in.
inline Planar chord_of(const Motion& motion, double yaw) noexcept {
  return rotated({motion.forward, motion.left}, yaw + motion.turn / 2) * sinc(motion.turn / 2);
}

}  // namespace robot_control
