#pragma once
/// Numbers in sentences.

#include <cstddef>
#include <cstdio>
#include <string>

namespace robot_control {

/// Returns what printf would write.
template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

}  // namespace robot_control
