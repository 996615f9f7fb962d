#pragma once
/// "a, b, c" of names or words, as messages to people have them.

#include <string>
#include <vector>

namespace robot_control {

inline std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace robot_control
