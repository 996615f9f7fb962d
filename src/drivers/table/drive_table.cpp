#include "drivers/table/drive_table.h"

#include <algorithm>

namespace robot_control {

double tolerated_silence(const Parameters& parameters, bool on_legs) {
  const bool simulated = parameters.driver == DriverName::kMujoco && !parameters.drives.empty();
  const std::string driver = simulated ? "can" : word_of(parameters.driver);
  double silence = 0;
  for (const DriveRow& row : kDriveRows) {
    if (row.driver == driver && (row.command == "impedance") == on_legs)
      silence = std::max(silence, row.make_file({.joints = {}, .rate = parameters.loop.rate})->tolerated_silence());
  }
  return silence;
}

}  // namespace robot_control
