#pragma once
/// The lying posture rests on the body. Its lowest point, the belly, is on the ground, and so is the lowest point of
/// each folded leg. So the robot lies still without any torque, wherever the limp legs sink to.
///
///   knee   bent by kFold, or as far as its range less kFromStop allows
///   thigh  turned from hanging down towards the side to which the knee points, so that the lowest point of thigh and
///          shank is as high as possible: foot and knee are then equally high
///   hip    swung outwards until no part of thigh and shank is below the belly, or to the end of its range

#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/leg_kinematics.h"

namespace robot_control {

inline constexpr double kFold = 2.7;       ///< rad
inline constexpr double kFromStop = 0.05;  ///< rad

/// Returns the height of the lowest point of the root body and of those that the legs' first joints move. It is in m of
/// the base's axes at the zero pose. `chains` holds the bodies of each leg.
double belly_height(const RigidBodies& robot, const std::array<std::array<std::size_t, kLegJoints>, 4>& chains);

/// Returns the angles of the leg whose bodies are `chain`.
LegAngles lying_posture(const RigidBodies& robot, const LegKinematics& kinematics,
                        const std::array<std::size_t, kLegJoints>& chain, double belly);

}  // namespace robot_control
