#pragma once
/// Motion along an exact circular arc, smooth through zero turn.
///
/// Over one step the base moves with a constant twist in its own axes: by `forward`, `left` [m] and `turn` [rad].
/// Integrating R(yaw) (forward, left) over a yaw that grows evenly by `turn` gives, with h = turn / 2,
///
///   (x, y) = sinc(h) · R(yaw + h) · (forward, left)       sinc(h) = sin(h) / h
///
/// the chord of the arc. At h → 0 this is the straight line. Near zero sinc is its series, so value and slope
/// are exact to rounding there too. REP 103: x forward, y left, turn positive to the left.

#include "signals/geometry.h"

namespace robot_control {

/// sinc(h) and d sinc / dh.
struct Sinc {
  double value = 1;
  double slope = 0;
};
Sinc sinc(double h) noexcept;

struct Motion {
  double forward = 0;  ///< m
  double left = 0;     ///< m
  double turn = 0;     ///< rad
};

/// The chord in the axes that `yaw` is measured in, and its derivatives by the motion.
struct Chord {
  double x = 0;  ///< m
  double y = 0;  ///< m
  double x_by_forward = 1, y_by_forward = 0;
  double x_by_left = 0, y_by_left = 1;
  double x_by_turn = 0, y_by_turn = 0;  ///< m/rad
};
Chord chord_of(const Motion& motion, double yaw) noexcept;

}  // namespace robot_control
