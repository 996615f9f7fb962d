#pragma once
/// All sequences of choices of a deterministic program, depth first.
///
///   Choices choices;
///   do {
///     program(choices);  // calls choose(n) wherever it could go on in n ways
///   } while (choices.next());

#include <cstddef>
#include <vector>

namespace robot_control::model {

class Choices {
 public:
  /// Returns the next choice, 0 … options − 1.
  std::size_t choose(std::size_t options) {
    if (options < 2) return 0;
    if (depth_ == path_.size()) path_.push_back({0, options});
    return path_[depth_++].taken;
  }

  /// Begins the next sequence; false after the last one.
  bool next() {
    depth_ = 0;
    while (!path_.empty() && path_.back().taken + 1 == path_.back().options) path_.pop_back();
    if (path_.empty()) return false;
    ++path_.back().taken;
    return true;
  }

 private:
  struct Choice {
    std::size_t taken;
    std::size_t options;
  };
  std::vector<Choice> path_;
  std::size_t depth_ = 0;
};

}  // namespace robot_control::model
