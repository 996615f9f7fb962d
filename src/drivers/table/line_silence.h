#pragma once
/// How old the samples of a driver may become without a fault of the robot, by the nature of its line.

#include <algorithm>

#include "configuration/parameters.h"
#include "drivers/board/board_parameters.h"
#include "drivers/roboclaw/roboclaw_parameters.h"

namespace robot_control {

/// Returns s. A board on a serial line has kMaxSilence cycles, and no longer than its own watchdog waits for an order.
/// A RoboClaw has kRoboclawSilence, other drivers have 0.
inline double tolerated_silence(const Parameters& parameters) noexcept {
  constexpr double kBoardWatchdog = 0.05;
  if (parameters.driver == DriverChoice::kRoboclaw) return kRoboclawSilence;
  if (parameters.driver != DriverChoice::kBoard) return 0;
  return std::min(static_cast<double>(kMaxSilence) * parameters.loop.period(), kBoardWatchdog);
}

}  // namespace robot_control
