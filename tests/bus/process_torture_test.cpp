/// Transfers ten million frames and ten million rows between two processes; scripts/bench frames takes a thousand
/// million.

#include <gtest/gtest.h>

#include "support/allocation_guard.h"
#include "support/bus/torture.h"

namespace robot_control::tests {

// A sanitizer observes one process at a time: there the wiring is tested.
constexpr std::uint64_t kCount = AllocationGuard::kCounts ? 10'000'000 : 100'000;

TEST(ProcessTorture, NoFrameIsTornAndNoneIsOlderThanTheOneBefore) {
  const TortureCount count = torture_frames(kCount);
  EXPECT_EQ(count.torn, 0u);
  EXPECT_EQ(count.reordered, 0u);
  EXPECT_GE(count.read, kCount);
  EXPECT_GE(count.written, kCount);
  EXPECT_GE(count.distinct, kCount / 100'000);
}

TEST(ProcessTorture, EveryRowComesOnceWholeAndInOrder) {
  const TortureCount count = torture_ring(kCount);
  EXPECT_EQ(count.torn, 0u);
  EXPECT_EQ(count.reordered, 0u);
  EXPECT_EQ(count.read, kCount);
}

}  // namespace robot_control::tests
