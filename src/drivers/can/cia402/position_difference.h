#pragma once
/// The velocity of a drive whose process data hold its position alone: the mean over the last kSamples samples,
///
///   v = (q_k − q_{k−n}) / (t_k − t_{k−n}),
///
/// which is half of that span old. Its step is one count per span. Raw positions of 32 bits may overflow.

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control::cia402 {

class PositionDifference {
 public:
  static constexpr std::size_t kSamples = 8;

  void clear() noexcept { count_ = 0; }

  /// Returns the position in counts, continued over the overflow of 32 bits.
  std::int64_t add(std::int32_t raw, std::int64_t now_ns) noexcept {
    const Sample& last = ring_[(count_ + kSamples) % (kSamples + 1)];
    const std::int64_t position =
        count_ == 0 ? raw
                    : last.position + static_cast<std::int32_t>(static_cast<std::uint32_t>(raw) -
                                                                static_cast<std::uint32_t>(last.position));
    ring_[count_++ % (kSamples + 1)] = {position, now_ns};
    return position;
  }

  /// Returns counts per second; 0 before the second sample.
  double velocity() const noexcept {
    if (count_ < 2) return 0;
    const Sample& newest = ring_[(count_ - 1) % (kSamples + 1)];
    const Sample& oldest = ring_[count_ <= kSamples ? 0 : count_ % (kSamples + 1)];
    const std::int64_t span_ns = newest.time_ns - oldest.time_ns;
    return span_ns <= 0 ? 0
                        : 1.0e9 * static_cast<double>(newest.position - oldest.position) / static_cast<double>(span_ns);
  }

 private:
  struct Sample {
    std::int64_t position = 0;
    std::int64_t time_ns = 0;
  };
  std::array<Sample, kSamples + 1> ring_{};
  std::size_t count_ = 0;  // samples since `clear`
};

}  // namespace robot_control::cia402
