#pragma once
/// How the wheels of a robot are stopped, derived from the machine.
///
/// wheel_brake computes how hard a wheel brakes:
///
///   effort      B = min(effort limit, max(B₀ − f, B₀/10)),  with F = a (m + Σ J/r²)
///                 slowing  B₀ = max(F/2, m g sin 5°, min(0.9 F, m g sin 10°)) r / n
///                 holding  B₀ = max(F/2, m g sin 10°) r / n
///   damping     d = 0.4 J/h
///   stiffness   k = 0.06 J/h²
///   hold speed  0.03 m/s / r
///
/// The robot has n drive wheels and the mass m. A wheel has the inertia J about its axle and the radius r; h is the
/// drive's time step. The dry friction f of joint and motor also brakes. At the deceleration a wheels lift
/// (machine/wheeled/tipping.h). A robot that tips easily is still held on slopes of 10°. It slows down on slopes of 5°,
/// and on steeper ones as far as it does not tip. A torque above the ground's friction is harmless, because the wheel
/// then slides.
///
/// d and k are four times below the stability limits of brake_law.h.

#include "gate/brake_law.h"
#include "gate/stop_action.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// s. On level ground a robot whose wheels damp loses 63 % of its speed in this time: 2 m/s² at 1 m/s.
inline constexpr double kDampTime = 0.5;

/// Returns the brake of a wheel; `motor_friction` is that of its motor at the wheel in N·m, `step` is h in s.
Brake wheel_brake(const DriveTrain& robot, std::size_t wheel, double motor_friction, double step);

/// Returns the stop action of a wheel. Its damping is m r²/(n kDampTime).
StopAction wheel_stop(const DriveTrain& robot, std::size_t wheel, StopKind kind);

}  // namespace robot_control
