#pragma once
/// A sentence with figures.

#include <cstdio>
#include <string>

namespace robot_control::navigation {

/// Returns what printf would write, up to 300 characters.
template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[300];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

}  // namespace robot_control::navigation
