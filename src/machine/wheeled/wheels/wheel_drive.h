#pragma once
/// Assumes the values of drives that a URDF leaves out.
///
///   effort    τ_μ + τ_loss: the tyre transmits τ_μ = μ (m g / n) r with μ = 1, and τ_loss is the joint's own friction
///             and damping at kLossSpeed (or its lower velocity limit). A limit counts as unknown if it is missing or
///             zero, above kImplausibleFactor · (τ_μ + τ_loss), or part of the pair 100 N·m, 100 rad/s that editors fill in
///   velocity  unknown if it is missing, zero, of that pair, or 1000 rad/s and more
///   rotor     a wheel's inertia about its axle is at least kDriveShare of the robot's share, (m/n) r². The difference
///             counts as the drive's rotor, seen through its gear. A wheel of some grams alone would make every torque
///             loop at 1 kHz unstable (kp dt/J < 1). Passive wheels have kCasterShare
/// m is the URDF's mass. n is the number of drive wheels, and for casters the number of all rolling bodies.

#include <vector>

#include "machine/wheeled/wheels/drive_wheels.h"

namespace robot_control {

inline constexpr double kImplausibleFactor = 10;
inline constexpr double kLossSpeed = 1;  ///< m/s at the rim
inline constexpr double kDriveShare = 0.05;
inline constexpr double kCasterShare = 0.02;

struct DriveLimits {
  double effort = 0;    ///< N·m, above zero
  double velocity = 0;  ///< rad/s; 0: unknown
};

/// Throws RobotError if an override is not above zero.
DriveLimits drive_limits(const RigidBodies& robot, const RunningGear& gear, const RollingBody& wheel,
                         const DriveTrainParameters& parameters, std::vector<RobotNote>& notes);

/// Sets rotor_inertia and adds it to inertia.
void assume_rotors(const RigidBodies& robot, RunningGear& gear, std::vector<RobotNote>& notes);

}  // namespace robot_control
