#pragma once
/// What was put in `delay` steps ago: out(k) = in(k − delay), before that the value it was filled with.
///
/// Holds all its values itself: no allocation after construction, a step costs two copies.

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace robot_control {

template <class Value, std::size_t Longest>
class DelayLine {
 public:
  /// Throws std::invalid_argument: longer than Longest.
  explicit DelayLine(std::size_t delay) : delay_(delay) {
    if (delay > Longest) {
      throw std::invalid_argument("delay of " + std::to_string(delay) + " steps, at most " + std::to_string(Longest));
    }
  }

  /// What comes out of the next `delay` steps.
  void fill(const Value& value) noexcept {
    for (std::size_t i = 0; i < delay_; ++i) values_[i] = value;
    next_ = 0;
  }

  /// In goes the value of this step, out comes that of `delay` steps ago, in its place.
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
