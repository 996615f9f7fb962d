#pragma once
/// The loop of the program unitree_bridge. It takes the commands of the driver from the loopback and sends them as
/// rt/lowcmd. It hands rt/lowstate with its own report to the driver (bridge_report.h).

#include <csignal>
#include <cstdint>
#include <functional>

#include "drivers/drive/drive_file.h"
#include "drivers/unitree_go/bridge/dds_network.h"

namespace robot_control::unitree::go {

/// Returns the monotonic time in ns.
using BridgeClock = std::function<std::int64_t()>;

/// Runs until `ends` is not 0. With kController it stands between the driver and the robot. With kRobot it stands
/// before a simulated robot at the address of the drive file. Throws DriverError and DdsError.
void run_bridge(const DriveFile& file, DdsSide side, const BridgeClock& clock, const volatile std::sig_atomic_t& ends);

}  // namespace robot_control::unitree::go
