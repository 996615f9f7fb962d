#pragma once
/// The set-up of the gate before any machine, and what its driver must be able to do:
///
///   velocity, end stops   the joint's own, as its URDF says or the `robot:` block
///   soft zone             kSoftPart of the range, at most kSoftAngle or kSoftLength

#include <vector>

#include "drivers/driver.h"
#include "gate/gate_parameters.h"
#include "machine/machine_model.h"

namespace robot_control {

inline constexpr double kSoftPart = 0.05;    ///< of the range
inline constexpr double kSoftAngle = 0.1;    ///< rad: 1 rad/s tapers to nothing within a third of a second
inline constexpr double kSoftLength = 0.02;  ///< m

/// One entry per joint of the robot.
std::vector<JointLimits> joint_limits(const MachineModel& robot);

/// Throws DriverError with the first joint that has a stop action whose modes the driver does not accept.
void require_stop_actions(const Driver& driver, const GateParameters& gate, const MachineModel& robot);

/// Throws DriverError with everything that the robot kind needs and the driver lacks, and the remedies.
void require_needs(const Driver& driver, const MachineNeeds& needs);

}  // namespace robot_control
