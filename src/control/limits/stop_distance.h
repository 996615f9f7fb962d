#pragma once
/// How far a robot goes straight on from a steady speed v until it stands, by the limits alone.
///
///   v ≥ d²/j:  s = v²/(2·d) + v·d/(2·j)      d reached after d/j, held, and faded within d/j again
///   v < d²/j:  s = v·√(v/j)                  never reached: j until v/2, then −j
///
/// d the deceleration, j the jerk limit (infinite: s = v²/(2·d)). Both ramps are symmetric about v/2, so s is v/2 times
/// their duration, v/d + d/j or 2·√(v/j). The sampled law of axis_limiter.h differs by less than v·dt.
///
/// To it comes v for as long as nobody brakes yet: from the cycle that takes the command to its torque one period of
/// the bus, before that what the message was under way or, after silence, cmd_vel_timeout. With default limits 0.55 m
/// from 1 m/s, 0.35 m in an emergency.

namespace robot_control {

/// m, ≥ 0. `speed` m/s of either sign, `deceleration` m/s² > 0, `jerk` m/s³ > 0.
double stop_distance(double speed, double deceleration, double jerk) noexcept;

}  // namespace robot_control
