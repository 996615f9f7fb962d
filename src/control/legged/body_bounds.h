#pragma once
/// How fast the body of a standing robot may move, from what its feet carry. With the forces f₀ of the feet that carry
/// the weight, and fᵢ those that accelerate axis i by one unit, both at the nominal pose,
///
///   Aᵢ = kPart min over feet of μ f₀z / (|fᵢxy| + μ |fᵢz|),   μ = kFriction
///
/// If the axes share their acceleration, Σ |aᵢ|/Aᵢ ≤ 1 (tracked_axis.h), every foot keeps the part 1 − kPart of its
/// load and stays within its friction cone, whatever is requested. This part is left for other poses and for
/// disturbances.
///
/// It is at least 0.1 m/s² or rad/s², also where the nominal pose does not bear the robot.
///
/// The speeds are 0.4 m/s and 0.9 rad/s of legs of 0.426 m, and change with √l and 1/√l. No angle is faster than 0.9
/// rad/s, so that roll and pitch together stay below the default of tip_over, 1.5 rad/s.

#include <array>

#include "control/legged/tracked_axis.h"
#include "machine/legs/leg_model.h"

namespace robot_control {

/// Returns the bounds of x, y and height in m, and of roll, pitch and yaw in rad. The nominal body is `height` m above
/// the one that lies level, and `ground` m is the height of the ground below the base of that one.
std::array<AxisBounds, 6> body_bounds(const LegModel& robot, double height, double ground);

}  // namespace robot_control
