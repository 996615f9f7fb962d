#pragma once
/// The lying posture rests on the body, and no leg bears it. So the robot lies still without any torque, wherever the
/// limp legs sink to.
///
///   body   it tilts lengthwise, from level to where the centre of gravity of the root body is lowest
///   knee   bent by kFold, or as far as its range less kFromStop allows
///   hip    swung outwards until no part of thigh and shank is below the ground on which the body lies, or to the
///          end of its range
///   thigh  turned from hanging down towards the side to which the knee points, so that the lowest point of thigh and
///          shank is as high as possible

#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/leg_kinematics.h"

namespace robot_control {

inline constexpr double kFold = 2.7;       ///< rad
inline constexpr double kFromStop = 0.05;  ///< rad

using LegChains = std::array<std::array<std::size_t, kLegJoints>, 4>;  ///< bodies of each leg

/// The root body and those that the legs' first joints move, at the zero pose.
struct Belly {
  double height = 0;               ///< m, of the lowest point in the base's axes
  Eigen::Vector3d down{0, 0, -1};  ///< in the base's axes, while it lies without legs
  double depth = 0;                ///< m, of the ground along `down`
};

Belly belly_of(const RigidBodies& robot, const LegChains& chains);

/// Returns how far a leg reaches below its third joint, in m, while the thigh hangs down and the shank is level.
double knee_radius(const RigidBodies& robot, const LegKinematics& kinematics,
                   const std::array<std::size_t, kLegJoints>& chain);

/// Returns the angles of the leg whose bodies are `chain`.
LegAngles lying_posture(const RigidBodies& robot, const LegKinematics& kinematics,
                        const std::array<std::size_t, kLegJoints>& chain, const Belly& belly);

}  // namespace robot_control
