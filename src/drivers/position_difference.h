#pragma once
/// The velocity of a motor whose drive sends its position alone: the mean over the last n samples,
///
///   v = (q_k − q_{k−n}) / (t_k − t_{k−n}),
///
/// which is half of that span old. Its step is that of the position per span.

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control {

class PositionDifference {
 public:
  static constexpr std::size_t kSamples = 8;  ///< the greatest n

  /// `samples` is n.
  explicit PositionDifference(std::size_t samples = kSamples) noexcept : ring_size_(samples + 1) {}

  void clear() noexcept { count_ = 0; }

  void add(double position, std::int64_t now_ns) noexcept { ring_[count_++ % ring_size_] = {position, now_ns}; }

  /// Returns the unit of the position per second; 0 before the second sample.
  double velocity() const noexcept {
    if (count_ < 2) return 0;
    const Sample& newest = ring_[(count_ - 1) % ring_size_];
    const Sample& oldest = ring_[count_ < ring_size_ ? 0 : count_ % ring_size_];
    const std::int64_t span_ns = newest.time_ns - oldest.time_ns;
    return span_ns <= 0 ? 0 : 1.0e9 * (newest.position - oldest.position) / static_cast<double>(span_ns);
  }

 private:
  struct Sample {
    double position = 0;
    std::int64_t time_ns = 0;
  };
  std::size_t ring_size_;  // n + 1
  std::array<Sample, kSamples + 1> ring_{};
  std::size_t count_ = 0;  // samples since `clear`
};

}  // namespace robot_control
