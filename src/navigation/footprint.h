#pragma once
/// The outline of a robot in the plane. It encloses all its shapes, seen from above.

#include <functional>
#include <vector>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control::navigation {

struct Point {
  double x = 0, y = 0;  ///< m
};

/// The corners are those of the tangents in 64 directions. The polygon holds the convex hull, and exceeds a slanted
/// side of length l by at most l/40.
struct Footprint {
  std::vector<Point> corners;  ///< in base axes, counter-clockwise
  double inscribed = 0;        ///< m, radius of the largest circle about the base's origin that lies inside
  double circumscribed = 0;    ///< m, radius of the smallest circle about it that holds the outline
  double half_width = 0;       ///< m, largest distance of a corner from the x axis

  /// Returns the distance of the point from the outline, m; negative inside. Beside a corner it is less than the true
  /// one.
  double distance(Point point) const noexcept;
};

/// `reach` returns how far the robot reaches from the base's origin along a unit vector, m. Throws
/// std::invalid_argument unless the base's origin lies inside.
Footprint footprint_of(const std::function<double(Point)>& reach);

/// Returns the outline of these bodies where they are. Throws std::invalid_argument for a robot without shapes or whose
/// base lies beside them.
Footprint footprint_of(const RigidBodies& robot);

/// Returns the outline that encloses these.
Footprint hull_of(const std::vector<Footprint>& outlines);

}  // namespace robot_control::navigation
