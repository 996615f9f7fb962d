#pragma once
/// Limits that a user leaves out, from the robot and from what its controller may ask of it. What is given stays.
///
/// With ω = commanded_wheel_speed, the fastest that the controller's speed limits ask of any wheel, but no more than
/// the slowest wheel's own velocity limit ω_m, of which the controller uses kUsableWheelSpeed (control/kinematics.h;
/// ω_m is left out where the robot knows none); τ a wheel's effort limit, J its inertia, T = 20 ms the window over
/// which wheel speeds are measured:
///
///   wheel_speed         Ω = max(1.1 ω, ω + kSpeedMargin, min(1.25 ω, ω_m))
///                       a quarter for overshoot, slopes and wheels that spin for a moment, where the wheel bears it
///   wheel_acceleration  max over wheels of 2 τ/J + Ω/T
///                       τ/J is what motor or brake give the wheel in the air, where it is lightest; twice, for
///                       friction that helps to brake and an inertia that is not known well. The ground can stop a
///                       wheel at once (a wall, a kerb, a landing): Ω within one window
///   power               Σ τ Ω: every motor at both its limits
///   stall               kStall; with several wheels a side kScrubbingStall: in a turn that begins, those of one side
///                       are dragged along by the others until their torque has grown, for 0.6 rad of way. Below 1
///                       kHz in proportion to the period: the loops' gains shrink so, and by as much more angle grows
///                       the torque that takes a wheel over a bump (seen at 100 Hz: more than 3 rad)
///   not_stopping        kNotStopping; with a period above kSlowLoop in proportion: at 100 Hz a wheel loop that was
///                       pushed swings back for 3.5 s, at 2 cm/s
///   runaway             max(0.2 Ω, kLeastRunaway); with a period above kSlowLoop in proportion, as a slow loop
///                       that has pushed a wheel up a bump lets it shoot down
///                       kLeastRunaway: a wheel loop that is being pushed, and 20 quanta of a wheel speed measured with
///                       4096 counts over T (0.077 rad/s)
///
/// Battery limits stay absent: no URDF tells a battery.

#include "robot/robot_model.h"
#include "safety/safety_parameters.h"

namespace robot_control {

inline constexpr double kSpeedMargin = 1.0;     ///< rad/s, 13 quanta as above: for robots that are driven slowly
inline constexpr double kLeastRunaway = 2.0;    ///< rad/s
inline constexpr double kStall = 0.5;           ///< rad, 5 cm of way; driving over bumps and ice needs 0.13
inline constexpr double kScrubbingStall = 1.2;  ///< rad
inline constexpr double kNotStopping = 2.0;     ///< s; light robots need 1.2 at 1 kHz
inline constexpr double kSlowLoop = 0.005;      ///< s
inline constexpr double kSpeedWindow = 0.02;    ///< s, T

/// rad/s: the least wheel_speed limit that lets wheels run at `commanded`, max(1.1 ω, ω + kSpeedMargin); and its
/// inverse.
double least_wheel_speed_limit(double commanded) noexcept;
double fastest_within(double wheel_speed_limit) noexcept;

/// `commanded_wheel_speed` rad/s, > 0; `period` s.
SafetyParameters derived_limits(const SafetyParameters& given, const RobotModel& robot, double commanded_wheel_speed,
                                double period = 0.001);

}  // namespace robot_control
