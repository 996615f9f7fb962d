#pragma once
/// The set-up of the gate: limits from the robot, the rest from the parameters.
///
///   velocity, end stops   the joint's own, as its URDF says or the `robot:` block
///   soft zone             kSoftPart of the range, at most kSoftAngle or kSoftLength
///   longest ramp          ⌈ramp_time/period⌉ + loss_cycles: the monitor's own deadline, and as long as a loss may last

#include <vector>

#include "configuration/parameters.h"
#include "gate/gate_parameters.h"
#include "machine/machine_model.h"

namespace robot_control {

inline constexpr double kSoftPart = 0.05;  ///< of the range
inline constexpr double kSoftAngle =
    0.1;  ///< rad; 1 rad/s that tapers with the way left is gone in a third of a second
inline constexpr double kSoftLength = 0.02;  ///< m

/// One entry per joint of the robot.
std::vector<JointLimits> joint_limits(const MachineModel& robot);

GateParameters gate_parameters(const Parameters& parameters);

}  // namespace robot_control
