#pragma once
/// The drives of one bus that speak CiA 402.

#include "drivers/cia402/cia402_parameters.h"
#include "drivers/drive/drive_set.h"

namespace robot_control::cia402 {

/// Returns the drives of these joints with their host. Two axes of one node belong together.
DriveSet cia402_drives(const std::vector<Cia402Parameters>& joints, std::uint8_t host_node, double period);

}  // namespace robot_control::cia402
