#pragma once
/// A DurationHistogram holds durations in fixed memory; its quantiles have a relative error of at most 0.8 %.
///
/// A duration v ≥ 64 ns lies in the octave [2^e, 2^(e+1)), which is divided into 64 buckets of the width w = 2^(e−6).
/// The middle of its bucket differs from v by at most w/2 ≤ v/128. Shorter durations have buckets of 1 ns. A negative
/// duration counts as 0, and one above 17.2 s (2^34 ns) as 17.2 s.

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control {

inline constexpr double kQuantileError = 1.0 / 128;  ///< relative

/// Durations in ns. All are 0 if there was no sample.
struct DurationFigures {
  std::uint64_t samples = 0;
  std::int64_t min = 0;
  std::int64_t p50 = 0;
  std::int64_t p99 = 0;
  std::int64_t p999 = 0;
  std::int64_t max = 0;
};

namespace durations {

inline constexpr int kBits = 6;
inline constexpr std::int64_t kPerOctave = std::int64_t{1} << kBits;
inline constexpr int kLastOctave = 33;
inline constexpr std::size_t kBuckets = static_cast<std::size_t>((kLastOctave - kBits + 2) * kPerOctave);

std::size_t bucket_of(std::int64_t duration_ns) noexcept;
std::int64_t middle_of(std::size_t bucket) noexcept;  ///< ns

/// `Count` must be able to hold the number of samples.
template <class Count>
struct Counts {
  std::array<Count, kBuckets> buckets{};
  std::uint64_t samples = 0;
  std::int64_t min = 0;  ///< ns, exact
  std::int64_t max = 0;  ///< ns, exact

  void add(std::int64_t duration_ns) noexcept {
    ++buckets[bucket_of(duration_ns)];
    if (samples == 0 || duration_ns < min) min = duration_ns;
    if (samples == 0 || duration_ns > max) max = duration_ns;
    ++samples;
  }

  template <class Other>
  void add_all(const Counts<Other>& other) noexcept {
    if (other.samples == 0) return;
    for (std::size_t i = 0; i < kBuckets; ++i) buckets[i] = static_cast<Count>(buckets[i] + other.buckets[i]);
    if (samples == 0 || other.min < min) min = other.min;
    if (samples == 0 || other.max > max) max = other.max;
    samples += other.samples;
  }
};

}  // namespace durations

using DurationHistogram = durations::Counts<std::uint64_t>;

/// A quantile q is the smallest duration to which at least a share q of the samples is equal or shorter.
DurationFigures figures_of(const DurationHistogram& histogram) noexcept;

/// RecentDurations holds the durations of one quantity since the start, and those of the last ten seconds.
class RecentDurations {
 public:
  static constexpr std::int64_t kSeconds = 10;

  /// `time_ns` is when the duration was measured. An older second than the last ten counts for `total` alone.
  void add(std::int64_t duration_ns, std::int64_t time_ns) noexcept;

  DurationFigures total() const noexcept { return figures_of(total_); }

  /// Returns the figures of the running second and the nine before it.
  DurationFigures recent(std::int64_t now_ns) const noexcept;

 private:
  /// 65,535 samples of a second suffice, because no loop is faster than 2 kHz.
  using Second = durations::Counts<std::uint16_t>;

  DurationHistogram total_;
  std::array<Second, kSeconds> seconds_;
  std::array<std::int64_t, kSeconds> numbers_{};  ///< time of each second in s; 0: it is empty
};

}  // namespace robot_control
