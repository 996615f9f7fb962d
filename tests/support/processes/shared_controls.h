#pragma once
/// The shared data of a test and its forked nodes: an operator's inputs, and the nodes that are missing.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bus/latest_value.h"
#include "signals/velocity_command.h"
#include "support/robots/spoiled_joint.h"

namespace robot_control {

enum class LoopNode : std::size_t { kPlant, kEstimator, kController, kMonitor, kTelemetry };

inline constexpr std::array<const char*, 5> kLoopNodeNames = {"mujoco_plant", "state_estimator",
                                                              "diff_drive_controller", "safety_monitor", "telemetry"};

inline constexpr std::array kLoop = {LoopNode::kPlant, LoopNode::kEstimator, LoopNode::kController, LoopNode::kMonitor};

constexpr std::size_t index_of(LoopNode node) {
  return static_cast<std::size_t>(node);
}

inline const char* name_of(LoopNode node) {
  return kLoopNodeNames[index_of(node)];
}

/// It lives in memory that the forked nodes share with the test. Counters count from the start of the receiving node,
/// like those of a ROS node.
struct SharedControls {
  LatestValue<VelocityCommand> command;       ///< to the controller
  LatestValue<OperatorInput> operator_input;  ///< to the monitor
  /// Per node, as of its last look: one bit for each node that it misses.
  std::array<std::atomic<std::uint64_t>, kLoopNodeNames.size()> missing{};
  /// The count by telemetry itself.
  std::atomic<std::uint64_t> lost_rows{0};
  std::atomic<std::uint64_t> unwritten_rows{0};
  SpoilRequest spoil;  ///< to the driver
};

inline std::uint64_t missing_bits(const std::vector<std::string>& names) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kLoopNodeNames.size(); ++i) {
    for (const std::string& name : names) {
      if (name == kLoopNodeNames[i]) bits |= std::uint64_t{1} << i;
    }
  }
  return bits;
}

}  // namespace robot_control
