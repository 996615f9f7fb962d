#include "support/allocation_guard.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

namespace robot_control::tests {

struct Aligned {
  alignas(64) double value = 0;
};

/// The compiler may remove an allocation whose memory is not used.
void keep(const void* memory) {
  asm volatile("" : : "g"(memory) : "memory");
}

struct AllocationGuardTest : testing::Test {
  void SetUp() override {
    if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  }
};

TEST_F(AllocationGuardTest, CountsNothingWhereNothingIsAllocated) {
  std::vector<double> reserved(16);
  AllocationGuard guard;
  reserved[3] = 1.0;
  keep(reserved.data());
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(AllocationGuardTest, CountsNewAndDelete) {
  AllocationGuard guard;
  auto value = std::make_unique<double>(1.0);
  keep(value.get());
  EXPECT_EQ(guard.count(), 1u);
  value.reset();
  EXPECT_EQ(guard.count(), 2u);
}

TEST_F(AllocationGuardTest, CountsOverAlignedNew) {
  AllocationGuard guard;
  const auto value = std::make_unique<Aligned>();
  keep(value.get());
  EXPECT_EQ(guard.count(), 1u);
}

TEST_F(AllocationGuardTest, CountsMallocCallocRealloc) {
  AllocationGuard guard;
  void* memory = std::malloc(8);
  keep(memory);
  memory = std::realloc(memory, 4096);
  keep(memory);
  std::free(memory);
  memory = std::calloc(2, 8);
  keep(memory);
  std::free(memory);
  EXPECT_EQ(guard.count(), 5u);
}

TEST_F(AllocationGuardTest, IgnoresOtherThreads) {
  std::uint64_t here = 1;
  std::thread other([] { keep(std::make_unique<double>(1.0).get()); });
  {
    AllocationGuard guard;
    other.join();
    here = guard.count();
  }
  EXPECT_LE(here, 1u);  // join may release the thread's state, once
}

}  // namespace robot_control::tests
