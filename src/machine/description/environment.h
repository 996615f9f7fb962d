#pragma once
/// Reads variables of the process's environment.

#include <cstdlib>
#include <string>

namespace robot_control {

/// Returns the value of a variable, or "" if it is not set.
inline std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace robot_control
