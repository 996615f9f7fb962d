#pragma once
/// A ProblemList collects all problems of an input, so that one error reports all of them.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "files/message_text.h"

namespace robot_control {

class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A problem is printed as one line: `path = value: rule [origin]; remedy`. Empty parts are left out.
struct Problem {
  std::string path;    ///< "robot.rate"
  std::string value;   ///< as in the input
  std::string rule;    ///< allowed values, with unit
  std::string origin;  ///< file:line, or origin of the overlay
  std::string remedy;  ///< action that solves the problem
};

class ProblemList {
 public:
  void add(Problem problem) { problems_.push_back(std::move(problem)); }
  bool empty() const { return problems_.empty(); }

  /// Returns one line per problem.
  std::vector<std::string> lines() const;

  /// Throws ParameterError with `subject` and one line per problem; returns if there is none.
  void throw_if_any(std::string_view subject) const;

 private:
  std::vector<Problem> problems_;
};

/// A listing has at most this many characters, so that a terminal shows it and ROS sends it in one message.
inline constexpr std::size_t kMaxListing = 1900;

/// Returns "`subject`: 2 problems" and one line per problem; beyond kMaxListing it ends with "… and 7 more".
std::string listing(std::string_view subject, const std::vector<std::string>& lines);

}  // namespace robot_control
