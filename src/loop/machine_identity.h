#pragma once
/// The identity of a machine is announced by the driver in the head of the sensors channel. Every other node compares
/// it with its own.

#include "configuration/loop_parameters.h"
#include "machine/machine_model.h"

namespace robot_control {

/// Returns the machine with rate and clock in its hash and source. A node of another rate or clock refuses as one of
/// another robot does.
MachineModel identified(MachineModel machine, const LoopParameters& loop);

}  // namespace robot_control
