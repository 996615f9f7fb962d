#pragma once
/// A drive of diffbot in virtual time, for logs.

#include <string>
#include <vector>

#include "simulation/closed_loop.h"

namespace robot_control {

inline Parameters drive_parameters(const std::vector<Overlay>& overlays = {}) {
  return read_parameters(std::string(PROJECT_DIRECTORY) + "/config/robot_params.yaml", overlays);
}

/// Calls `visit(row)` in each of `cycles`; the robot drives a curve from the start.
template <class Visit>
void drive(ClosedLoop& loop, std::uint64_t cycles, Visit visit) {
  for (std::uint64_t i = 0; i < cycles; ++i) {
    if (i % 500 == 20) loop.command({.linear = {0.4, 0, 0}, .angular = {0, 0, 0.3}});
    loop.step();
    visit(loop.row());
  }
}

}  // namespace robot_control
