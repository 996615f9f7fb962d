#pragma once
/// The rows of drive_table.def as values.

#include <array>
#include <memory>
#include <string_view>

#include "configuration/parameters.h"
#include "drivers/drive/drive_file.h"

namespace robot_control {

struct DriveRow {
  std::string_view name, driver, command;
  std::unique_ptr<DriveFile> (*make_file)(DriveFileRequest request);
};

inline constexpr std::array kDriveRows{
#define DRIVE(name, driver, command) DriveRow{#name, #driver, #command, &make_##name##_file},
#include "drivers/drive_table.def"
};

/// Returns how old in s the samples of the driver may become without a fault of the robot, by the nature of its line.
/// Drives of wheels and of legs may share a driver.
double tolerated_silence(const Parameters& parameters, bool on_legs);

}  // namespace robot_control
