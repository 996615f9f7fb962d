#pragma once
/// The free distance along a motion. The safety monitor's `clearance` is derived from it.

#include <limits>
#include <optional>
#include <vector>

#include "navigation/footprint.h"
#include "navigation/moving_objects.h"

namespace robot_control::navigation {

inline constexpr double kLookAhead = 4.0;      ///< m; what is farther ahead limits no speed: 1 m/s² stops from 2.8 m/s
inline constexpr double kLaserNoise = 0.02;    ///< m of air about the outline: noise of the laser
inline constexpr double kRemainingGap = 0.01;  ///< m that also stay ahead: motion within one step of the search

struct FreeWay {
  double distance = std::numeric_limits<double>::infinity();  ///< m of the base's path
  std::optional<Point> obstacle;                              ///< in base axes: what ends it
};

/// Returns how far the outline may go along the arc of this motion, whose direction counts, until a point is within
/// kLaserNoise, less kRemainingGap. It is in m of the base's path, ∞ beyond kLookAhead. For a turn on the spot it is
/// the path of the outline's widest point, ∞ beyond a whole turn. Without motion it is the distance straight ahead.
///
/// `points` are in base axes. A point that lies deeper than kLaserNoise inside the outline is a part of the robot. A
/// point that is nearer than kLaserNoise at the start counts if the motion brings it nearer.
///
/// `objects`, in base axes, are in motion. Within kPredictionTime, each counts at its position when the robot arrives.
FreeWay free_way(const Footprint& footprint, const std::vector<Point>& points, const PlanarMotion& motion,
                 const std::vector<MovingObject>& objects = {});

}  // namespace robot_control::navigation
