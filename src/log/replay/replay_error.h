#pragma once

#include <stdexcept>

namespace robot_control {

/// A log cannot be replayed; the message names the reason and the remedy.
struct ReplayError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace robot_control
