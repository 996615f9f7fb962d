/// One writer writes as fast as it can; a reader must never get a torn frame, nor an older one after a newer.

#include <gtest/gtest.h>

#include <thread>

#include "bus/latest_frames.h"
#include "rt/clock.h"
#include "support/bus/test_frame.h"
#include "support/processes/anonymous_memory.h"

namespace robot_control::tests {

constexpr std::uint64_t kTorturedRun = 7;
constexpr std::int64_t kDuration = 700'000'000;    // ns, at least
constexpr std::int64_t kTimeout = 60'000'000'000;  // ns; the number of frames in a time depends on the machine
constexpr std::uint64_t kFrames = 100;             // at least

void write_until(const std::atomic<bool>& stop, LatestFrames<TestFrame>* memory) {
  FrameWriter<TestFrame> writer(memory);
  for (std::uint64_t cycle = 0; !stop.load(std::memory_order_relaxed); ++cycle) {
    TestFrame frame = test_frame(kTorturedRun, cycle);
    writer.publish(frame);
  }
}

/// Reads for kDuration and kFrames, in both ways; returns the number of frames found.
std::uint64_t read_and_check(const LatestFrames<TestFrame>* memory) {
  const FrameReader<TestFrame> reader(memory);
  TestFrame frame;
  std::uint64_t last = 0;
  std::uint64_t seen = 0;
  const std::int64_t begin = monotonic_ns();
  while ((seen < kFrames || monotonic_ns() < begin + kDuration) && monotonic_ns() < begin + kTimeout) {
    const Lookup newest = reader.newest(frame);
    EXPECT_NE(newest, Lookup::kCorrupt);
    if (newest != Lookup::kFrame) continue;
    EXPECT_TRUE(whole(frame));
    EXPECT_GE(frame.head.cycle, last);
    last = frame.head.cycle;
    ++seen;
    const std::uint64_t asked = last > 3 ? last - 3 : 0;
    const Lookup older = reader.at(kTorturedRun, asked, frame);
    EXPECT_NE(older, Lookup::kCorrupt);
    if (older == Lookup::kFrame) {
      EXPECT_TRUE(whole(frame));
      EXPECT_EQ(frame.head.cycle, asked);
    }
    if (testing::Test::HasFailure()) break;
  }
  return seen;
}

TEST(LatestFramesTorture, TwoThreadsSeeWholeFramesInOrder) {
  const AnonymousMemory<LatestFrames<TestFrame>> memory;
  std::atomic<bool> stop{false};
  std::thread writer([&] { write_until(stop, memory.get()); });
  EXPECT_GE(read_and_check(memory.get()), kFrames);
  stop.store(true);
  writer.join();
}

}  // namespace robot_control::tests
