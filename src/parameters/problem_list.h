#pragma once
/// Collects all problems of an input, so that one error reports all of them.

#include <string>
#include <string_view>
#include <vector>

#include "files/message_text.h"

namespace robot_control {

/// Printed as one line: `path = value: rule [origin]; remedy`. Empty parts are left out.
struct Problem {
  std::string path;    ///< "robot.rate"
  std::string value;   ///< as it was written
  std::string rule;    ///< what would have been right, with unit
  std::string origin;  ///< file:line, or where an overlay came from
  std::string remedy;  ///< what to do about it
};

class ProblemList {
 public:
  void add(Problem problem) { problems_.push_back(std::move(problem)); }
  bool empty() const { return problems_.empty(); }

  /// The line of each problem.
  std::vector<std::string> lines() const;

  /// Throws ParameterError with every problem on a line of its own below `subject`; returns if there is none.
  void throw_if_any(std::string_view subject) const;

 private:
  std::vector<Problem> problems_;
};

/// Characters of a listing: what a terminal shows, and ROS carries in one message.
inline constexpr std::size_t kMaxListing = 1900;

/// "`subject`: 2 problems", and each of them on a line of its own below; beyond kMaxListing "… and 7 more".
std::string listing(std::string_view subject, const std::vector<std::string>& lines);

/// Shortest text that reads back as the same number.
std::string shortest(double value);

}  // namespace robot_control
