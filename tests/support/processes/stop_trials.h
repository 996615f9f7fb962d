#pragma once
/// Trials of one loss: full speed, signal, standstill, restart of the node, reset, again.

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/processes/driving_robot.h"

namespace robot_control {

struct LossCell {
  LoopNode node;
  int signal;
};

inline constexpr auto kLossCells = std::to_array<LossCell>({
    {LoopNode::kController, SIGKILL},
    {LoopNode::kController, SIGSTOP},
    {LoopNode::kMonitor, SIGKILL},
    {LoopNode::kMonitor, SIGSTOP},
    {LoopNode::kEstimator, SIGKILL},
    {LoopNode::kEstimator, SIGSTOP},
});

struct StopTrials {
  std::vector<double> cycles;  ///< from the signal to the brake
  std::vector<double> ways;    ///< m to standstill
  int repeated = 0;            ///< trials that this machine disturbed, and that were repeated
};

inline std::string to_name(const LossCell& cell) {
  return std::string(name_of(cell.node)) + (cell.signal == SIGKILL ? "_killed" : "_stopped");
}

inline std::string to_text(const LossCell& cell) {
  return std::string(name_of(cell.node)) + (cell.signal == SIGKILL ? " SIGKILL" : " SIGSTOP");
}

inline double median_of(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

inline double greatest_of(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

inline std::string to_text(const StopTrials& trials) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "brake after %.0f cycles, at most %.0f, of %zu trials; %.3f m, at most %.3f; %d repeated",
                median_of(trials.cycles), greatest_of(trials.cycles), trials.cycles.size(), median_of(trials.ways),
                greatest_of(trials.ways), trials.repeated);
  return text.data();
}

/// The number of disturbed trials that are allowed beyond the requested ones.
inline constexpr int kRepeatedTrials = 20;

/// Throws std::runtime_error if the robot does not stop, does not drive again, or too many trials are disturbed.
inline StopTrials run_trials(DrivingRobot& robot, const LossCell& cell, int count) {
  StopTrials trials;
  while (static_cast<int>(trials.cycles.size()) < count) {
    robot.drive_at_full_speed();
    const MeasuredStop stop = robot.lose(cell.node, cell.signal);
    if (stop.measured()) {
      trials.cycles.push_back(static_cast<double>(stop.cycles));
      trials.ways.push_back(stop.distance);
    } else if (++trials.repeated > count + kRepeatedTrials) {
      throw std::runtime_error("this machine stalls too often to measure anything");
    }
    robot.bring_back(cell.node, cell.signal);
    robot.release();
  }
  return trials;
}

}  // namespace robot_control
