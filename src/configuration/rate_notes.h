#pragma once
/// A node says at its start what a slow loop costs.

#include <string>
#include <string_view>
#include <vector>

#include "configuration/parameters.h"

namespace robot_control {

/// Hz of robot.rate from which on the figures of the documentation hold.
inline constexpr double kMinPromisedRate = 100;

inline bool is_slow(const LoopParameters& loop) noexcept {
  return loop.rate < kMinPromisedRate;
}

/// Returns the sentences of the node whose block of parameters is `block`:
///
///   topics that come with every cycle, less often than their parameter says
///   safety monitor of a slow loop: the time from the loss of a node to the brake
std::vector<std::string> rate_notes(Parameters parameters, std::string_view block);

}  // namespace robot_control
