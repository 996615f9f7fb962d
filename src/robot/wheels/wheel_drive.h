#pragma once
/// What a URDF leaves out of its drives.
///
///   effort   τ_μ + τ_loss: what the tyre can transmit, τ_μ = μ (m g / n) r with μ = 1, and what the joint's own
///            friction and damping cost at kLossSpeed (or its velocity limit, where that is lower). Unknown is a limit
///            that is missing or zero, above kImplausible · (τ_μ + τ_loss), or the pair 100 N·m, 100 rad/s that editors
///            fill in.
///   velocity unknown: missing, zero, that pair, or 1000 rad/s and more.
///   rotor    a wheel's inertia about its axle is at least kDriveShare of the robot's share, (m/n) r². What is missing
///            is taken for the drive's rotor, seen through its gear: a wheel of some grams alone, which no real drive
///            moves, would make every torque loop at 1 kHz unstable (kp dt/J < 1). Passive wheels: kCasterShare.
/// m is the URDF's mass, n the number of drive wheels, for casters that of all that roll.

#include <string>
#include <vector>

#include "robot/wheels/drive_wheels.h"

namespace robot_control {

inline constexpr double kImplausible = 10;
inline constexpr double kLossSpeed = 1;  ///< m/s at the rim
inline constexpr double kDriveShare = 0.05;
inline constexpr double kCasterShare = 0.02;

struct DriveLimits {
  double effort = 0;    ///< N·m, above zero
  double velocity = 0;  ///< rad/s; 0: none known
};

/// Throws RobotError: an override that is not above zero.
DriveLimits drive_limits(const RigidBodies& robot, const DriveTrain& train, const RollingBody& wheel,
                         const RobotParameters& parameters, std::vector<RobotNote>& notes);

/// Sets rotor_inertia and adds it to inertia.
void assume_rotors(const RigidBodies& robot, DriveTrain& train, std::vector<RobotNote>& notes);

}  // namespace robot_control
