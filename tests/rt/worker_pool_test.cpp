#include "rt/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace robot_control::tests {

struct WorkerPoolTest : testing::TestWithParam<std::size_t> {
  WorkerPool pool_{GetParam()};
};

TEST_P(WorkerPoolTest, CallsTheFunctionOnceForEveryNumberInEveryRound) {
  for (const std::size_t count : {0U, 1U, 3U, 1000U, 2U}) {
    std::vector<int> calls(count);
    pool_.for_each(count, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(count, 1));
  }
}

TEST_P(WorkerPoolTest, ThrowsWhatACallThrewAfterAllOthersHaveEnded) {
  std::atomic<int> ended{0};
  const auto work = [&](std::size_t i) {
    if (i == 5) throw std::runtime_error("call 5");
    ++ended;
  };
  EXPECT_THROW(pool_.for_each(20, work), std::runtime_error);
  EXPECT_EQ(ended, 19);
  EXPECT_NO_THROW(pool_.for_each(3, [](std::size_t) {})) << "the exception is thrown once";
}

INSTANTIATE_TEST_SUITE_P(Threads, WorkerPoolTest, testing::Values(1, 2, 5));

TEST(WorkerPool, ASlowCallKeepsOneThreadBusyAndNoMore) {
  WorkerPool pool(2);
  std::atomic<int> quick{0};
  std::atomic<bool> met{false};
  pool.for_each(10, [&](std::size_t i) {
    if (i != 0) {
      ++quick;
      return;
    }
    while (quick < 9) std::this_thread::yield();  // the other thread makes the nine calls
    met = true;
  });
  EXPECT_TRUE(met);
}

TEST(WorkerPool, RefusesToHaveNoThread) {
  EXPECT_THROW(WorkerPool(0), std::invalid_argument);
}

}  // namespace robot_control::tests
