#pragma once
/// The faults of simulated drives by words, as `~inject_fault` and ClosedLoop take them. The component is a joint or
/// `bus`. The kinds of the bus are ok, off, lossy and disturbed. Off means that the driver's cable is out, lossy that 5
/// % of the frames are lost. On a disturbed bus the others are late as well, by up to one period.

#include <span>
#include <string>
#include <string_view>

#include "simulation/devices/simulated_drives.h"

namespace robot_control {

/// `joints` are those of the drives, `host` is the driver's party on the bus. Returns the problem with the list of
/// words; "" if there is none.
std::string inject_device_fault(SimulatedDrives& drives, std::span<const std::string> joints, std::size_t host,
                                std::string_view component, std::string_view kind);

}  // namespace robot_control
