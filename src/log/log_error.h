#pragma once

#include <stdexcept>

namespace robot_control {

/// The message names the file, the reason and the remedy.
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace robot_control
