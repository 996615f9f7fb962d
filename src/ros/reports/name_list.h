#pragma once
/// Joins names or words to the text "a, b, c".

#include <string>
#include <vector>

namespace robot_control {

inline std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace robot_control
