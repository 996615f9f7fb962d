#include "machine/description/wording.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace robot_control {

std::string link_element(const std::string& name) {
  return "<link name=\"" + name + "\">";
}

std::string joint_element(const std::string& name) {
  return "<joint name=\"" + name + "\">";
}

std::string number(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

std::string length(double metres) {
  return number(std::round(1e6 * metres) / 1e6 + 0.0);  // no "-0"
}

std::string list(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += (result.empty() ? "" : ", ") + name;
  return result.empty() ? "none" : result;
}

std::string lower_case(std::string text) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  std::transform(text.begin(), text.end(), text.begin(), lower);
  return text;
}

bool says_left(const std::string& name) {
  return lower_case(name).find("left") != std::string::npos;
}

bool says_right(const std::string& name) {
  return lower_case(name).find("right") != std::string::npos;
}

std::string on_one_line(std::string text) {
  text.erase(text.find_last_not_of(" \n") + 1);
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at)) text.replace(at, 1, "; ");
  return text;
}

}  // namespace robot_control
