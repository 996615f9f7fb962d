#pragma once
/// The simulated devices of any drive of drive_table.def.

#include <memory>

#include "drivers/drive/device_front.h"

namespace robot_control {

/// Returns the devices that the file describes.
std::unique_ptr<DeviceFront> make_front(const DriveFile& file, FrontSetup setup);

/// Returns the devices' end of the true lines at the addresses of the file. Throws DriverError.
LineEnd open_devices_end(const DriveFile& file);

}  // namespace robot_control
