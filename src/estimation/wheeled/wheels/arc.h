#pragma once
/// Computes motion along an exact circular arc, smooth through zero turn.
///
/// Over one step the base moves with a constant twist in its own axes, by `forward` and `left` [m] and `turn` [rad].
/// The integral of R(yaw) (forward, left) over the turn is the chord of the arc. With h = turn / 2 it is
///
///   (x, y) = sinc(h) · R(yaw + h) · (forward, left)       sinc(h) = sin(h) / h
///
/// REP 103: x forward, y left, turn positive to the left.

#include <cmath>

#include "estimation/common/values.h"

namespace robot_control {

struct Motion {
  double forward = 0;  ///< m
  double left = 0;     ///< m
  double turn = 0;     ///< rad
};

inline double sinc(double h) noexcept {
  return h == 0 ? 1 : std::sin(h) / h;
}

/// Returns the chord in m, in the axes in which `yaw` is measured.
inline Planar chord_of(const Motion& motion, double yaw) noexcept {
  return rotated({motion.forward, motion.left}, yaw + motion.turn / 2) * sinc(motion.turn / 2);
}

}  // namespace robot_control
