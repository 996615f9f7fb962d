#pragma once
/// The free way ahead, from the laser alone, without map and localisation. The safety monitor's `clearance` follows it.

#include <vector>

#include "navigation/costmap.h"
#include "navigation/moving_objects.h"

namespace robot_control::navigation {

inline constexpr double kLookAhead = 4.0;   ///< m; what is farther ahead limits no speed: 1 m/s² stops from 2.8 m/s
inline constexpr double kStopShort = 0.03;  ///< m that stay between the outline and an obstacle
inline constexpr double kBeside = 0.02;     ///< m of air beside the outline: noise of the laser

/// The motion that is intended or measured; its ratio counts, and for a turn on the spot its sign.
struct PlanarMotion {
  double linear = 0;   ///< m/s
  double angular = 0;  ///< rad/s
};

/// Returns how far the outline may go along the arc of this motion until a point is within kBeside, less kStopShort. It
/// is in m of the base's way, ∞ beyond kLookAhead. For a turn on the spot it is the way of the outline's widest place,
/// ∞ beyond a whole turn. Without motion it is the way straight ahead.
///
/// `points` are in base axes. A point inside the outline is a part of the robot. One that is nearer than kBeside at the
/// start counts if the motion brings it nearer.
///
/// `objects`, in base axes, are things in motion. Within kForesight, each counts where it is when the robot arrives.
double free_way(const Footprint& footprint, const std::vector<Point>& points, const PlanarMotion& motion,
                const std::vector<MovingObject>& objects = {});

}  // namespace robot_control::navigation
