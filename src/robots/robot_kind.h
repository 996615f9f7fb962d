#pragma once
/// The kind of a robot follows from its URDF.
///
///   legs     at least two chains of joints on the root body are legs (machine/legs/leg_model.h)
///   wheels   every other robot

#include <memory>

#include "configuration/parameters.h"
#include "machine/machine_model.h"

namespace robot_control {

enum class RobotKind { kWheels, kLegs };

/// Throws RobotError as read_rigid_bodies.
RobotKind kind_of(const RobotDescription& description);

/// Returns the machine of its kind: a DriveTrain or a LegModel. Throws RobotError as read_drive_train or read_legs.
std::unique_ptr<MachineModel> read_robot(const RobotDescription& description, const Parameters& parameters);

}  // namespace robot_control
