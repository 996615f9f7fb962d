#include "rt/cycle_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/allocation_guard.h"

namespace robot_control {
namespace {

/// By the definition: the least value that at least this fraction of all do not exceed.
std::int64_t exact_quantile(std::vector<std::int64_t> values, double fraction) {
  std::ranges::sort(values);
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

TEST(CycleStatistics, IsZeroWhenEmpty) {
  const CycleStatistics statistics;
  EXPECT_EQ(statistics.count(), 0u);
  EXPECT_EQ(statistics.min(), 0);
  EXPECT_EQ(statistics.max(), 0);
  EXPECT_EQ(statistics.mean(), 0);
  EXPECT_EQ(statistics.p99(), 0);
}

TEST(CycleStatistics, OfOneValueIsThatValue) {
  CycleStatistics statistics;
  statistics.add(1'000'123);
  EXPECT_EQ(statistics.min(), 1'000'123);
  EXPECT_EQ(statistics.max(), 1'000'123);
  EXPECT_EQ(statistics.mean(), 1'000'123);
  EXPECT_EQ(statistics.p50(), 1'000'123);
  EXPECT_EQ(statistics.p999(), 1'000'123);
}

TEST(CycleStatistics, CountLeastGreatestAndMeanAreExact) {
  CycleStatistics statistics;
  for (const std::int64_t value : {999'999, 1'000'000, 1'000'004}) statistics.add(value);
  EXPECT_EQ(statistics.count(), 3u);
  EXPECT_EQ(statistics.min(), 999'999);
  EXPECT_EQ(statistics.max(), 1'000'004);
  EXPECT_DOUBLE_EQ(statistics.mean(), 3'000'003.0 / 3);
}

TEST(CycleStatistics, IsExactBelow128) {
  CycleStatistics statistics;
  for (std::int64_t value = 0; value < 128; ++value) statistics.add(value);
  for (std::int64_t value = 1; value < 128; ++value) {
    EXPECT_EQ(statistics.quantile(static_cast<double>(value) / 128), value - 1);
  }
}

TEST(CycleStatistics, QuantilesAreWithinHalfABucket) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    std::lognormal_distribution<double> latency(std::log(20e3), 1.5);  // from below 1 µs to above 1 ms
    CycleStatistics statistics;
    std::vector<std::int64_t> values(5000);
    for (std::int64_t& value : values) {
      value = static_cast<std::int64_t>(latency(random));
      statistics.add(value);
    }
    for (const double fraction : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const auto exact = static_cast<double>(exact_quantile(values, fraction));
      EXPECT_NEAR(static_cast<double>(statistics.quantile(fraction)), exact, exact / 128 + 1)
          << "seed " << seed << " fraction " << fraction;
    }
  }
}

TEST(CycleStatistics, TakesValuesOutsideItsRange) {
  CycleStatistics statistics;
  statistics.add(-5);
  statistics.add(std::int64_t{1} << 50);
  EXPECT_EQ(statistics.min(), -5);
  EXPECT_EQ(statistics.max(), std::int64_t{1} << 50);
  EXPECT_EQ(statistics.quantile(0.5), 0);
  EXPECT_NEAR(static_cast<double>(statistics.quantile(1)), std::pow(2, 40), std::pow(2, 40) / 64);
}

TEST(CycleStatistics, ClearMakesItEmpty) {
  CycleStatistics statistics;
  statistics.add(5);
  statistics.clear();
  EXPECT_EQ(statistics.count(), 0u);
  statistics.add(7);
  EXPECT_EQ(statistics.min(), 7);
}

TEST(CycleStatistics, AddAllocatesNothing) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  CycleStatistics statistics;
  AllocationGuard guard;
  statistics.add(1'000'000);
  EXPECT_EQ(statistics.p99(), 1'000'000);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace robot_control
