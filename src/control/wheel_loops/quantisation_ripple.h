#pragma once
/// The torque that the wheel loop makes of the quantisation of the encoder.
///
/// A loop that is stable and damped with an exact encoder (wheel_loop_stability.h) can oscillate with a real one: each
/// count that contradicts the tracking loop is a step of speed, kp times that a step of torque, which turns the wheel
/// to the next count. The lifted wheel oscillates most, and a tyre is soft enough for the loaded one to do nearly the
/// same: on simulated robots at 80 … 99 Hz of tracking_bandwidth 0.06 … 0.7 of the torque limit, by this law 0.11 …
/// 0.68 (docs/evidence/derivations.md).
///
/// The wheel of wheel_loop_stability.h with the plan of a ramp of half a second to `speed`, encoder with kCounts per
/// turn. Result: RMS of the torque less its low pass of 5 Hz, over the half-second that begins a quarter after the
/// ramp.

#include "control/wheel_loops/wheel_loop.h"
#include "control/wheel_loops/wheel_loop_stability.h"

namespace robot_control {

inline constexpr int kCounts = 4096;  ///< a turn of a wheel

/// N·m. `bandwidth` Hz of the tracking loop, `effort_limit` N·m, `speed` rad/s, `period` s > 0. Some 100 µs.
double quantisation_ripple(const WheelLoopGains& gains, const WheelLoad& load, double bandwidth, double effort_limit,
                           double speed, double period);

}  // namespace robot_control
