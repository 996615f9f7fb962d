#include "drivers/table/drive_table.h"

#include <algorithm>

namespace robot_control {

double tolerated_silence(const Parameters& parameters) {
  double silence = 0;
  for (const DriveRow& row : kDriveRows) {
    if (row.driver == word_of(parameters.driver))
      silence = std::max(silence, row.make_file({.joints = {}, .rate = parameters.loop.rate})->tolerated_silence());
  }
  return silence;
}

}  // namespace robot_control
