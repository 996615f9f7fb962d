#pragma once
/// The kind of a robot follows from its URDF, unless Parameters::kind names it.
///
///   legs     has_legs of machine/legs/leg_chains.h
///   wheels   every other robot

#include <memory>
#include <string_view>

#include "configuration/parameters.h"
#include "machine/machine_model.h"
#include "robots/robot.h"

namespace robot_control {

enum class MachineKind { kOnWheels, kOnLegs };

/// Throws RobotError as read_moving_bodies.
MachineKind kind_of(const RobotDescription& description, KindChoice choice = KindChoice::kDerived);

/// Returns the parameters within what the drives of Parameters::drives can do (robots/wheeled/within_drives.h); those
/// of a robot on legs are as given. Throws as read_robot, and ParameterError with all problems of the drive file.
Parameters limited_by_drives(const Parameters& parameters, const RobotDescription& description);

/// Returns the machine of its kind: a DriveTrain or a LegModel. Throws RobotError as read_drive_train or read_legs.
std::unique_ptr<MachineModel> read_robot(const RobotDescription& description, const Parameters& parameters);

MachineKind kind_of(const MachineModel& machine) noexcept;

/// Returns the name of the kind (signals/robot_kinds.h).
std::string_view name_of(MachineKind kind) noexcept;

/// Returns the robot of a machine of `read_robot`, composed of the laws of its kind.
std::unique_ptr<Robot> compose(const Parameters& parameters, const MachineModel& machine);

/// Returns the robot of Parameters::urdf, composed of the laws of its kind. Throws RobotError as read_robot.
std::unique_ptr<Robot> make_robot(const Parameters& parameters);

}  // namespace robot_control
