#include "timing/duration_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace robot_control::tests {

constexpr std::int64_t kSecond = 1'000'000'000;

/// Durations from ns to minutes, of which most are short: log-normal, median 10 µs.
std::vector<std::int64_t> latencies(unsigned seed, std::size_t count) {
  std::mt19937_64 random(seed);
  std::lognormal_distribution<double> duration(std::log(1e4), 2.0);
  std::vector<std::int64_t> values(count);
  for (std::int64_t& value : values) value = std::llround(duration(random));
  return values;
}

std::int64_t quantile(std::vector<std::int64_t> sorted, double share) {
  std::ranges::sort(sorted);
  return sorted[static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size()))) - 1];
}

TEST(DurationHistogram, EveryBucketHoldsItsMiddleWithinTheStatedError) {
  for (std::int64_t duration = 0; duration < (std::int64_t{1} << 34); duration += 1 + duration / 100) {
    const std::int64_t middle = durations::middle_of(durations::bucket_of(duration));
    ASSERT_EQ(durations::bucket_of(middle), durations::bucket_of(duration)) << duration;
    ASSERT_LE(std::abs(static_cast<double>(middle - duration)), kQuantileError * static_cast<double>(duration) + 0.5)
        << duration;
  }
}

TEST(DurationHistogram, QuantilesOfRandomLatenciesAreThoseOfTheSortedSamplesWithinTheStatedError) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const std::vector<std::int64_t> values = latencies(seed, 5000);
    DurationHistogram histogram;
    for (const std::int64_t value : values) histogram.add(value);
    const DurationFigures figures = figures_of(histogram);
    const auto near = [&](std::int64_t found, double share) {
      const auto exact = static_cast<double>(quantile(values, share));
      EXPECT_NEAR(static_cast<double>(found), exact, kQuantileError * exact + 1) << "seed " << seed << ", " << share;
    };
    near(figures.p50, 0.5);
    near(figures.p99, 0.99);
    near(figures.p999, 0.999);
    EXPECT_EQ(figures.min, std::ranges::min(values));
    EXPECT_EQ(figures.max, std::ranges::max(values));
    EXPECT_EQ(figures.samples, values.size());
  }
}

TEST(DurationHistogram, HasFiguresOfZeroWithoutASample) {
  const DurationFigures figures = figures_of({});
  EXPECT_EQ(figures.samples, 0u);
  EXPECT_EQ(figures.max, 0);
}

TEST(DurationHistogram, DurationsOutsideItsRangeCountAtItsEnds) {
  EXPECT_EQ(durations::bucket_of(-5), 0u);
  EXPECT_EQ(durations::bucket_of(std::int64_t{1} << 40), durations::kBuckets - 1);
}

TEST(RecentDurations, ForgetsWhatIsOlderThanTenSecondsAndTheTotalDoesNot) {
  RecentDurations durations;
  for (std::int64_t second = 100; second < 130; ++second) durations.add(second, second * kSecond);
  const DurationFigures recent = durations.recent(129 * kSecond);
  EXPECT_EQ(recent.samples, 10u);
  EXPECT_EQ(recent.min, 120);
  EXPECT_EQ(recent.max, 129);
  EXPECT_EQ(durations.total().samples, 30u);
  EXPECT_EQ(durations.total().min, 100);
}

TEST(RecentDurations, AreEmptyTenSecondsAfterTheLastSample) {
  RecentDurations durations;
  durations.add(5, 100 * kSecond);
  EXPECT_EQ(durations.recent(109 * kSecond).samples, 1u);
  EXPECT_EQ(durations.recent(110 * kSecond).samples, 0u);
}

TEST(RecentDurations, ASampleOfALongPastSecondCountsForTheTotalAlone) {
  RecentDurations durations;
  durations.add(5, 100 * kSecond);
  durations.add(7, 90 * kSecond);
  EXPECT_EQ(durations.recent(100 * kSecond).samples, 1u);
  EXPECT_EQ(durations.total().samples, 2u);
}

}  // namespace robot_control::tests
