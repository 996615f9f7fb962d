#pragma once
/// Random damage to a text, for the fuzzes of what reads it.

#include <random>
#include <string>
#include <string_view>

namespace robot_control {

inline std::string damaged(std::string text, std::mt19937& random) {
  const auto pick = [&](std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound == 0 ? 0 : bound - 1)(random);
  };
  const std::string_view marks = ":#-[]{}\"'\n \t,!&*|>%@?.~\0\xff";
  for (std::size_t count = 1 + pick(8); count > 0; --count) {
    const std::size_t place = pick(text.size());
    switch (pick(5)) {
      case 0:
        text.erase(place, pick(40));
        break;
      case 1:
        text.insert(place, 1, marks[pick(marks.size())]);
        break;
      case 2:
        text.insert(place, text.substr(pick(text.size()), pick(80)));
        break;
      case 3:
        if (!text.empty()) text[place] = static_cast<char>(pick(256));
        break;
      default:
        text.insert(place, std::string(pick(600), marks[pick(marks.size())]));
    }
  }
  return text;
}

}  // namespace robot_control
