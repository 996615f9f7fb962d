#pragma once
/// Computes the torque that the wheel loop makes of the quantisation of the encoder.
///
/// A loop that is stable and damped with an exact encoder (wheel_loop_stability.h) can oscillate with a real one. Each
/// count that contradicts the tracking loop is a step of speed. The gain kp makes a step of torque of it, which turns
/// the wheel to the next count. The lifted wheel oscillates most, and a tyre is soft enough for a loaded one to do
/// nearly the same. Figures are in docs/evidence/derivations.md.
///
/// The wheel of wheel_loop_stability.h follows a ramp of half a second to `speed`. Its encoder has kCounts per turn.
/// The result is the RMS of the torque minus its low pass of 5 Hz, over the half-second that begins a quarter after the
/// ramp.

#include "control/wheeled/wheel_loops/wheel_loop.h"
#include "control/wheeled/wheel_loops/wheel_loop_stability.h"

namespace robot_control {

inline constexpr int kCounts = 4096;  ///< per turn of a wheel

/// Returns N·m and takes some 100 µs. `bandwidth` (Hz) is that of the tracking loop; `effort_limit` is in N·m, `speed`
/// in rad/s and `period` in s > 0.
double quantisation_ripple(const WheelLoopGains& gains, const WheelLoad& load, double bandwidth, double effort_limit,
                           double speed, double period);

}  // namespace robot_control
