#include "timing/duration_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace robot_control {
namespace durations {

std::size_t bucket_of(std::int64_t duration_ns) noexcept {
  constexpr std::int64_t kMax = (std::int64_t{1} << (kLastOctave + 1)) - 1;
  const auto value = static_cast<std::uint64_t>(std::clamp(duration_ns, std::int64_t{0}, kMax));
  const int shift = std::max(static_cast<int>(std::bit_width(value)) - 1 - kBits, 0);
  return static_cast<std::size_t>(shift) * kPerOctave + (value >> shift);
}

std::int64_t middle_of(std::size_t bucket) noexcept {
  const auto place = static_cast<std::int64_t>(bucket);
  const std::int64_t shift = std::max(place / kPerOctave - 1, std::int64_t{0});
  const std::int64_t width = std::int64_t{1} << shift;
  return (place - shift * kPerOctave) * width + width / 2;
}

}  // namespace durations

DurationFigures figures_of(const DurationHistogram& histogram) noexcept {
  DurationFigures figures{.samples = histogram.samples, .min = histogram.min, .max = histogram.max};
  const auto quantile = [&](double share) {
    const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(histogram.samples)));
    std::uint64_t counted = 0;
    std::size_t bucket = 0;
    while (bucket + 1 < durations::kBuckets && (counted += histogram.buckets[bucket]) < rank) ++bucket;
    return std::clamp(durations::middle_of(bucket), histogram.min, histogram.max);
  };
  if (figures.samples == 0) return figures;
  figures.p50 = quantile(0.5);
  figures.p99 = quantile(0.99);
  figures.p999 = quantile(0.999);
  return figures;
}

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns

}  // namespace

void RecentDurations::add(std::int64_t duration_ns, std::int64_t time_ns) noexcept {
  total_.add(duration_ns);
  const std::int64_t number = time_ns / kSecond;
  const auto place = static_cast<std::size_t>(number % kSeconds);
  if (number < numbers_[place]) return;
  if (number > numbers_[place]) seconds_[place] = {};
  numbers_[place] = number;
  seconds_[place].add(duration_ns);
}

DurationFigures RecentDurations::recent(std::int64_t now_ns) const noexcept {
  DurationHistogram sum;
  for (std::size_t i = 0; i < seconds_.size(); ++i) {
    if (numbers_[i] > now_ns / kSecond - kSeconds) sum.add_all(seconds_[i]);
  }
  return figures_of(sum);
}

}  // namespace robot_control
