#pragma once

#include <stdexcept>

namespace robot_control {

/// What could not be written, why, what to do.
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace robot_control
