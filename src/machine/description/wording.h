#pragma once
/// These functions word messages and notes: `<link name="…">`, numbers with six digits.

#include <string>
#include <vector>

namespace robot_control {

std::string link_element(const std::string& name);
std::string joint_element(const std::string& name);

/// Returns six significant digits: "0.1", "1e-09".
std::string number(double value);

/// Returns a length in m, rounded to a micrometre, so that it does not show what is left of a sum of zero.
std::string length(double metres);

/// Returns "a, b, c", or "none" for an empty list.
std::string list(const std::vector<std::string>& names);

/// Returns true if `name` contains "left" or "right" in either case.
bool says_left(const std::string& name);
bool says_right(const std::string& name);

std::string lower_case(std::string text);

/// Returns the lines of a message with "; " between them.
std::string on_one_line(std::string text);

}  // namespace robot_control
