#include "bus/latest_value.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "rt/clock.h"

namespace robot_control::tests {

struct Value {
  std::array<std::uint64_t, 60> words{};
};

Value value_of(std::uint64_t number) {
  Value value;
  value.words.fill(number);
  return value;
}

TEST(LatestValue, HoldsItsInitialValue) {
  const LatestValue<Value> latest(value_of(3));
  Value value;
  ASSERT_TRUE(latest.load(value));
  EXPECT_EQ(value.words, value_of(3).words);
}

TEST(LatestValue, HoldsTheValueStoredLast) {
  LatestValue<Value> latest;
  latest.store(value_of(1));
  latest.store(value_of(2));
  Value value;
  ASSERT_TRUE(latest.load(value));
  EXPECT_EQ(value.words, value_of(2).words);
}

TEST(LatestValue, HasAnotherVersionAfterEveryStoreAndNoOtherTime) {
  LatestValue<Value> latest;
  const std::uint64_t before = latest.version();
  latest.store(value_of(0));
  const std::uint64_t after = latest.version();
  EXPECT_NE(after, before);
  Value value;
  ASSERT_TRUE(latest.load(value));
  EXPECT_EQ(latest.version(), after);
}

TEST(LatestValue, IsNeverTornAndNeverGoesBack) {
  LatestValue<Value> latest;
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    for (std::uint64_t number = 1; !stop.load(std::memory_order_relaxed); ++number) latest.store(value_of(number));
  });
  Value value;
  std::uint64_t last = 0;
  std::uint64_t loads = 0;
  const std::int64_t begin = monotonic_ns();
  // The number of loads in a time depends on the machine; patience only ends a hang.
  while ((loads < 100 || monotonic_ns() < begin + 500'000'000) && monotonic_ns() < begin + 60'000'000'000) {
    if (!latest.load(value)) continue;
    ++loads;
    ASSERT_EQ(value.words, value_of(value.words[0]).words);
    ASSERT_GE(value.words[0], last);
    last = value.words[0];
  }
  stop.store(true);
  writer.join();
  EXPECT_GE(loads, 100u);
}

}  // namespace robot_control::tests
