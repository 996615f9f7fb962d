#pragma once
/// Computes the distance that a robot drives straight on from a steady speed v until it stands, by the limits alone.
///
///   v ≥ d²/j:  s = v²/(2·d) + v·d/(2·j)      d is reached after d/j, held, and reduced to 0 within d/j
///   v < d²/j:  s = v·√(v/j)                  d is not reached: jerk j until v/2, then −j
///
/// d is the deceleration and j the jerk limit; if j is infinite, s = v²/(2·d). Both ramps are symmetric about v/2, so s
/// is v/2 times their duration v/d + d/j or 2·√(v/j). The sampled law of axis_limiter.h differs by less than v·dt.
///
/// The robot also drives v before the ramp begins: one period of the bus from the cycle that reads the command to its
/// torque. Before that come the transport time of the message or, after silence, cmd_vel_timeout. With default limits s
/// is 0.55 m from 1 m/s, 0.35 m in an emergency.

namespace robot_control {

/// Returns m, ≥ 0. `speed` (m/s) has either sign; `deceleration` (m/s²) and `jerk` (m/s³) are > 0.
double stop_distance(double speed, double deceleration, double jerk) noexcept;

}  // namespace robot_control
