#pragma once
/// The free distance along a motion, from the laser alone. The safety monitor's `clearance` is derived from it.

#include <vector>

#include "navigation/costmap.h"
#include "navigation/moving_objects.h"

namespace robot_control::navigation {

inline constexpr double kLookAhead = 4.0;      ///< m; what is farther ahead limits no speed: 1 m/s² stops from 2.8 m/s
inline constexpr double kRemainingGap = 0.03;  ///< m that stay between the outline and an obstacle
inline constexpr double kLaserNoise = 0.02;    ///< m of air beside the outline: noise of the laser

/// The motion that is intended or measured; its ratio counts, and for a turn on the spot its sign.
struct PlanarMotion {
  double linear = 0;   ///< m/s
  double angular = 0;  ///< rad/s
};

/// Returns how far the outline may go along the arc of this motion until a point is within kLaserNoise, less
/// kRemainingGap. It is in m of the base's path, ∞ beyond kLookAhead. For a turn on the spot it is the path of the
/// outline's widest point, ∞ beyond a whole turn. Without motion it is the distance straight ahead.
///
/// `points` are in base axes. A point inside the outline is a part of the robot. A point that is nearer than
/// kLaserNoise at the start counts if the motion brings it nearer.
///
/// `objects`, in base axes, are in motion. Within kPredictionTime, each counts at its position when the robot arrives.
double clearance_along(const Footprint& footprint, const std::vector<Point>& points, const PlanarMotion& motion,
                       const std::vector<MovingObject>& objects = {});

}  // namespace robot_control::navigation
