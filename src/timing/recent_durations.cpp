#include "timing/recent_durations.h"

namespace robot_control {
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
