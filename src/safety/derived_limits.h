#pragma once
/// Limits that the user left out, derived from the robot and from the speed limits of its controller. Given limits
/// stay.
///
/// ω = commanded_wheel_speed: the largest speed that the controller's speed limits command to any wheel, at most the
/// velocity limit ω_m of the slowest wheel, of which the controller uses kUsableWheelSpeed (kinematics.h). Terms with
/// ω_m are omitted if the robot has no velocity limit. τ: a wheel's effort limit, J: its inertia, T = max(20 ms,
/// 2 periods): the window over which wheel speeds are measured.
///
///   wheel_speed         Ω = max(1.1 ω, ω + kSpeedMargin, min(1.25 ω, ω_m))
///                       a quarter more for overshoot, slopes and short wheel spin, if the wheel may turn so fast
///   wheel_acceleration  max over wheels of 2 τ/J + Ω/T
///                       τ/J is the acceleration of the lifted wheel under full torque of motor or brake. The factor 2
///                       covers friction, which adds to braking, and an inertia that is not known well. The ground can
///                       stop a wheel at once (wall, kerb, landing): Ω within one window
///   power               Σ τ Ω: every motor at its effort limit and at its speed limit
///   stall               kStall; with several wheels a side kScrubbingStall: when a turn begins, some wheels of a side
///                       are dragged by the others until their torque has grown. With a period above 1 ms in proportion
///                       to the period, because the gains become smaller and so more angle error is needed for the same
///                       torque
///   not_stopping        kNotStopping; with a period above kSlowLoop in proportion: a slow wheel loop that was pushed
///                       takes longer to settle
///   runaway             max(0.2 Ω, kMinRunaway); with a period above kSlowLoop in proportion: a slow loop that
///                       pushed a wheel up a bump lets it overspeed on the way down.
///                       kMinRunaway covers a wheel loop that is pushed, and 20 quanta of a wheel speed measured with
///                       4096 counts over T (0.077 rad/s)
///
/// Battery limits are never derived: a URDF does not describe the battery. Measured values:
/// docs/evidence/derivations.md.

#include "machine/wheeled/drive_train.h"
#include "safety/safety_parameters.h"

namespace robot_control {

inline constexpr double kSpeedMargin = 1.0;     ///< rad/s, 13 quanta as above; for slow robots
inline constexpr double kMinRunaway = 2.0;      ///< rad/s
inline constexpr double kStall = 0.5;           ///< rad; docs/evidence/derivations.md
inline constexpr double kScrubbingStall = 1.2;  ///< rad; docs/evidence/derivations.md
inline constexpr double kNotStopping = 2.0;     ///< s; docs/evidence/derivations.md
inline constexpr double kSlowLoop = 0.005;      ///< s
inline constexpr double kSpeedWindow = 0.02;    ///< s, T

/// rad/s: the smallest wheel_speed limit with which wheels may run at `commanded`, max(1.1 ω, ω + kSpeedMargin); and
/// the inverse function.
double least_wheel_speed_limit(double commanded) noexcept;
double fastest_within(double wheel_speed_limit) noexcept;

/// `commanded_wheel_speed` rad/s, > 0; `period` s.
SafetyParameters derived_limits(const SafetyParameters& given, const DriveTrain& robot, double commanded_wheel_speed,
                                double period = 0.001);

}  // namespace robot_control
