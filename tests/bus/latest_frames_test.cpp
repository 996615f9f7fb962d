#include "bus/latest_frames.h"

#include <gtest/gtest.h>

#include "rt/clock.h"
#include "support/allocation_guard.h"
#include "support/bus/test_frame.h"
#include "support/processes/anonymous_memory.h"

namespace robot_control::tests {

constexpr std::uint64_t kRun = 7;

/// Cycles 0 … 9 of run 7 were published.
struct LatestFramesTest : testing::Test {
  LatestFramesTest() {
    for (std::uint64_t cycle = 0; cycle < 10; ++cycle) publish(kRun, cycle);
  }

  void publish(std::uint64_t run, std::uint64_t cycle) {
    TestFrame frame = test_frame(run, cycle);
    writer_.publish(frame);
  }

  AnonymousMemory<LatestFrames<TestFrame>> memory_;
  FrameWriter<TestFrame> writer_{memory_.get()};
  FrameReader<TestFrame> reader_{memory_.get()};
  TestFrame found_;
};

TEST_F(LatestFramesTest, NewestIsTheOnePublishedLast) {
  ASSERT_EQ(reader_.newest(found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.cycle, 9u);
  EXPECT_TRUE(whole(found_));
}

TEST_F(LatestFramesTest, NewestIsTheOnePublishedLastNotTheGreatestCycle) {
  publish(kRun + 1, 0);
  ASSERT_EQ(reader_.newest(found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.run, kRun + 1);
  EXPECT_EQ(found_.head.cycle, 0u);
}

TEST_F(LatestFramesTest, KeepsTheLastEightCycles) {
  EXPECT_EQ(reader_.at(kRun, 1, found_), Lookup::kMissing);  // overwritten by 9
  for (std::uint64_t cycle = 2; cycle < 10; ++cycle) {
    ASSERT_EQ(reader_.at(kRun, cycle, found_), Lookup::kFrame) << cycle;
    EXPECT_EQ(found_.head.cycle, cycle);
  }
  EXPECT_EQ(reader_.at(kRun, 10, found_), Lookup::kMissing);  // not yet
}

TEST_F(LatestFramesTest, RefusesAnotherRun) {
  EXPECT_EQ(reader_.at(kRun + 1, 9, found_), Lookup::kMissing);
  EXPECT_EQ(reader_.newest_within(kRun + 1, 6, 9, found_), Lookup::kMissing);
}

TEST_F(LatestFramesTest, FindsNothingInMemoryNeverWritten) {
  const AnonymousMemory<LatestFrames<TestFrame>> empty;
  const FrameReader<TestFrame> reader(empty.get());
  EXPECT_EQ(reader.newest(found_), Lookup::kMissing);
  EXPECT_EQ(reader.at(0, 0, found_), Lookup::kMissing);
}

TEST_F(LatestFramesTest, FindsNothingBeforeAChannelIsMapped) {
  const FrameReader<TestFrame> reader;
  EXPECT_EQ(reader.newest(found_), Lookup::kMissing);
  EXPECT_EQ(reader.at(kRun, 9, found_), Lookup::kMissing);
  EXPECT_FALSE(reader.wait(0, 1'000'000));
}

TEST_F(LatestFramesTest, NewestWithinSearchesDownwards) {
  ASSERT_EQ(reader_.newest_within(kRun, 8, 11, found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.cycle, 9u);
  EXPECT_EQ(reader_.newest_within(kRun, 10, 11, found_), Lookup::kMissing);
}

TEST_F(LatestFramesTest, NewestWithinReachesCycleZero) {
  publish(kRun + 1, 0);
  ASSERT_EQ(reader_.newest_within(kRun + 1, 0, 3, found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.cycle, 0u);
}

TEST_F(LatestFramesTest, ReportsACorruptFrame) {
  TestFrame frame = test_frame(kRun, 10);
  seal(frame);
  frame.values[50] ^= 1;
  writer_.store(frame);
  EXPECT_EQ(reader_.at(kRun, 10, found_), Lookup::kCorrupt);
  EXPECT_EQ(reader_.newest(found_), Lookup::kCorrupt);
  EXPECT_EQ(reader_.newest_within(kRun, 6, 10, found_), Lookup::kCorrupt);
}

TEST_F(LatestFramesTest, ReportsAToken) {
  TestFrame token = test_frame(kRun, 10);
  token.head.kind = FrameKind::kToken;
  writer_.publish(token);
  EXPECT_EQ(reader_.at(kRun, 10, found_), Lookup::kToken);
  EXPECT_EQ(reader_.newest(found_), Lookup::kToken);
}

TEST_F(LatestFramesTest, NewestWithinPassesOverATokenToTheFrameBefore) {
  TestFrame token = test_frame(kRun, 10);
  token.head.kind = FrameKind::kToken;
  writer_.publish(token);
  ASSERT_EQ(reader_.newest_within(kRun, 7, 10, found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.cycle, 9u);
}

TEST_F(LatestFramesTest, AWriterKilledHalfWayLeavesItsSlotUnreadableAndTheOthersWhole) {
  auto& slot = memory_->slots[10 % kFrameSlots];
  slot.version.fetch_or(1);
  slot.words[3].store(0xdead);
  EXPECT_EQ(reader_.at(kRun, 10, found_), Lookup::kMissing);
  EXPECT_EQ(reader_.at(kRun, 2, found_), Lookup::kMissing);
  ASSERT_EQ(reader_.newest(found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.cycle, 9u);
}

TEST_F(LatestFramesTest, WhatAnEndedWriterLeftIsItsLastFrameAndNotTheOneWithTheLatestStamp) {
  TestFrame frame = test_frame(kRun + 1, 0);
  frame.head.stamp_ns = 0;  // of a driver that was started again in lockstep, or of none
  writer_.publish(frame);
  ASSERT_EQ(reader_.last_whole(found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.run, kRun + 1);
}

TEST_F(LatestFramesTest, TheNextPublicationHealsASlotLeftHalfWritten) {
  auto& slot = memory_->slots[10 % kFrameSlots];
  slot.version.fetch_or(1);
  slot.words[3].store(0xdead);
  FrameWriter<TestFrame> successor(memory_.get());
  TestFrame frame = test_frame(kRun, 10);
  successor.publish(frame);
  ASSERT_EQ(reader_.at(kRun, 10, found_), Lookup::kFrame);
  EXPECT_TRUE(whole(found_));
  EXPECT_EQ(slot.version.load() % 2, 0u);
}

TEST_F(LatestFramesTest, SequenceCountsPublicationsOverAllWriters) {
  EXPECT_EQ(reader_.sequence(), 10u);
  FrameWriter<TestFrame> successor(memory_.get());
  TestFrame frame = test_frame(kRun, 10);
  successor.publish(frame);
  EXPECT_EQ(reader_.sequence(), 11u);
}

TEST_F(LatestFramesTest, WaitReturnsAtOnceWhenThereIsSomethingNew) {
  EXPECT_TRUE(reader_.wait(9, -1));
}

TEST_F(LatestFramesTest, WaitEndsAtItsTimeout) {
  const std::int64_t timeout_ns = 2 * FrameReader<TestFrame>::kRemapNs + 5'000'000;
  const std::int64_t before_ns = monotonic_ns();
  EXPECT_FALSE(reader_.wait(reader_.sequence(), timeout_ns));
  EXPECT_GE(monotonic_ns() - before_ns, timeout_ns);
}

TEST_F(LatestFramesTest, ReadingAndWritingAllocateNothing) {
  AllocationGuard guard;
  publish(kRun, 10);
  reader_.newest(found_);
  reader_.newest_within(kRun, 7, 10, found_);
  reader_.wait(10, 0);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests
