#include "files/ascii.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace robot_control {
namespace {

struct Sign {
  std::string_view utf8;
  std::string_view ascii;
};

constexpr auto kSigns = std::to_array<Sign>({
    {"·", "*"},  {"²", "^2"},  {"³", "^3"}, {"°", " deg"}, {"√", "sqrt "}, {"±", "+-"}, {"×", "x"},
    {"−", "-"},  {"…", "..."}, {"→", "->"}, {"µ", "u"},    {"Ω", "Ohm"},   {"σ", "s"},  {"≤", "<="},
    {"≥", ">="}, {"∞", "inf"}, {"–", "-"},  {"“", "\""},   {"”", "\""},    {"’", "'"},  {"¹", "^1"},
});

}  // namespace

std::string ascii(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto byte = static_cast<unsigned char>(text.front());
    const auto* sign = std::ranges::find_if(kSigns, [&](const Sign& known) { return text.starts_with(known.utf8); });
    if (byte < 0x80) {
      result += text.front();
    } else if (sign != kSigns.end()) {
      result += sign->ascii;
      text.remove_prefix(sign->utf8.size());
      continue;
    } else {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\x%02X", static_cast<unsigned>(byte));
      result += escape.data();
    }
    text.remove_prefix(1);
  }
  return result;
}

}  // namespace robot_control
