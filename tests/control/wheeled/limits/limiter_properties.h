#pragma once
/// Properties of the limiter for any commands, tested by one random sequence of commands per seed.
///
///   finite        every speed is a number
///   speed         no axis above its speed limit
///   acceleration  none above the limit of its phase; what an emergency left fades at the jerk limit
///   jerk          none above the limit, but where an axis stops at zero, and then it is said
///   zero          no axis is beyond zero unless its target is, or was when it went there
///   overshoot     a target is passed by no more than a²/(2·jerk) of the acceleration at the time it was given
///   arrival       a target that stays is reached exactly, within the time of its S-curve, and kept
///   curvature     from standstill, and from a steady motion to it, the commanded one where it is to be kept
///   reverse       the mirrored commands under mirrored limits give the mirrored motion, bit for bit
///
/// Limits may differ between forward and reverse.

#include <cstdint>
#include <optional>
#include <string>

namespace robot_control {

inline constexpr int kLimiterCycles = 200;

/// The property that `seed` violates, with place and cause; none if all hold.
std::optional<std::string> limiter_violation(std::uint64_t seed);

}  // namespace robot_control
