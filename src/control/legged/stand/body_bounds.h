#pragma once
/// How the body of a standing robot may move, from what its feet carry. The nominal pose is level, its centre of
/// gravity above the middle of the feet, which stand where they lay. With the forces f₀ of the feet that carry the
/// weight there, and fᵢ those that accelerate axis i by one unit,
///
///   Aᵢ = kUsedShare min over feet of μ f₀z / (|fᵢxy| + μ |fᵢz|),   μ = kFriction
///
/// f₀ is vertical. If the axes share their acceleration, Σ |aᵢ|/Aᵢ ≤ 1 (tracked_axis.h), every foot keeps the part
/// 1 − kUsedShare of its load and of its grip while all four stand, whatever is requested. This part is left for other
/// poses, for the times on three feet, and for disturbances. Aᵢ is at least 0.1 m/s² or rad/s².
///
/// The speeds are 0.4 m/s and 0.9 rad/s of legs of 0.426 m, and change with √l and 1/√l. No angle is faster than
/// 0.9 rad/s, so that roll and pitch together stay below the default of tip_over, 1.5 rad/s.

#include <array>

#include "control/legged/tracked_axis.h"
#include "machine/legs/leg_model.h"

namespace robot_control {

/// Returns the bounds of x, y and height in m, and of roll, pitch and yaw in rad.
std::array<AxisBounds, 6> body_bounds(const LegModel& robot);

/// Returns after how many s at most a standing robot lies, whatever its pose and wherever its foot in the air is.
///
/// Let n be the distance from the ends of all ranges and w the speed of the body, in the norm of tracked_axis.h. The
/// body stops within w. The foot comes above its place, goes down and takes its load. Then the body returns to the
/// nominal pose within n/w + w, and sinks within the rise time.
double lying_down_time(const LegModel& robot);

}  // namespace robot_control
