#pragma once
/// Distribution of durations, in ns, of fixed size: `add` is a few instructions and never allocates.
///
/// Log-linear buckets: 64 to each power of two, so bucket width / value <= 1/64; a quantile is the middle of
/// its bucket and thus within 1/128 = 0.8 % of the value that was added (below 128 ns it is that value).
/// Count, least, greatest and mean are exact. Negative values count as 0 in the quantiles; values above 2^40 ns
/// (18 minutes) as 2^40.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace robot_control {

class CycleStatistics {
 public:
  void add(std::int64_t value_ns) noexcept {
    least_ = count_ == 0 ? value_ns : std::min(least_, value_ns);
    greatest_ = count_ == 0 ? value_ns : std::max(greatest_, value_ns);
    sum_ += value_ns;
    ++count_;
    ++buckets_[bucket_of(value_ns)];
  }

  void clear() noexcept { *this = CycleStatistics{}; }

  std::uint64_t count() const noexcept { return count_; }
  std::int64_t min() const noexcept { return least_; }     ///< ns; 0 when empty, as all below
  std::int64_t max() const noexcept { return greatest_; }  ///< ns
  double mean() const noexcept { return count_ == 0 ? 0.0 : static_cast<double>(sum_) / static_cast<double>(count_); }

  /// The least value that at least `fraction` (0 … 1) of all values do not exceed, ns.
  std::int64_t quantile(double fraction) const noexcept {
    if (count_ == 0) return 0;
    const auto rank = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(std::ceil(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(count_))));
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      below += buckets_[i];
      if (below >= rank) return std::clamp(middle_of(i), least_, greatest_);
    }
    return greatest_;
  }

  std::int64_t p50() const noexcept { return quantile(0.5); }
  std::int64_t p99() const noexcept { return quantile(0.99); }
  std::int64_t p999() const noexcept { return quantile(0.999); }

 private:
  static constexpr int kBits = 6;  // 2^kBits buckets to a power of two
  static constexpr int kMaxBits = 40;
  static constexpr std::uint64_t kPerOctave = 1u << kBits;
  static constexpr std::size_t kBuckets = (kMaxBits - kBits + 1) * kPerOctave + 1;

  static std::size_t bucket_of(std::int64_t value_ns) noexcept {
    const auto value = static_cast<std::uint64_t>(std::clamp<std::int64_t>(value_ns, 0, std::int64_t{1} << kMaxBits));
    if (value < kPerOctave) return value;
    const int shift = static_cast<int>(std::bit_width(value)) - 1 - kBits;
    return static_cast<std::size_t>(shift) * kPerOctave + (value >> shift);
  }

  static std::int64_t middle_of(std::size_t bucket) noexcept {
    if (bucket < 2 * kPerOctave) return static_cast<std::int64_t>(bucket);
    const auto shift = static_cast<int>(bucket / kPerOctave) - 1;
    const std::uint64_t low = (bucket % kPerOctave + kPerOctave) << shift;
    return static_cast<std::int64_t>(low + (std::uint64_t{1} << shift) / 2);
  }

  std::uint64_t count_ = 0;
  std::int64_t least_ = 0;
  std::int64_t greatest_ = 0;
  std::int64_t sum_ = 0;
  std::array<std::uint64_t, kBuckets> buckets_{};
};

}  // namespace robot_control
