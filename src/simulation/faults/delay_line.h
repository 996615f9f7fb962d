#pragma once
/// A DelayLine delays values by `delay` steps: out(k) = in(k − delay); before that, the value that it was filled with.
///
/// It holds all its values itself: there is no allocation after construction, and a step costs two copies.

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace robot_control {

template <class Value, std::size_t Longest>
class DelayLine {
 public:
  /// Throws std::invalid_argument if `delay` > Longest.
  explicit DelayLine(std::size_t delay) : delay_(delay) {
    if (delay > Longest) {
      throw std::invalid_argument("delay of " + std::to_string(delay) + " steps, at most " + std::to_string(Longest));
    }
  }

  /// Makes `value` the output of the next `delay` steps.
  void fill(const Value& value) noexcept {
    for (std::size_t i = 0; i < delay_; ++i) values_[i] = value;
    next_ = 0;
  }

  /// Replaces the value of this step by that of `delay` steps ago.
  void step(Value& value) noexcept {
    if (delay_ == 0) return;
    const Value late = values_[next_];
    values_[next_] = value;
    value = late;
    next_ = next_ + 1 == delay_ ? 0 : next_ + 1;
  }

  std::size_t delay() const noexcept { return delay_; }

 private:
  std::size_t delay_;
  std::size_t next_ = 0;
  std::array<Value, Longest> values_{};
};

}  // namespace robot_control
