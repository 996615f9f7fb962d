#include "bus/ring.h"

#include <gtest/gtest.h>

#include <thread>

#include "support/allocation_guard.h"
#include "support/processes/anonymous_memory.h"
#include "support/processes/child_process.h"

namespace robot_control::tests {

struct WideRow {
  std::array<std::uint64_t, 40> values{};
};

WideRow row_of(std::uint64_t number) {
  WideRow row;
  row.values.fill(number);
  return row;
}

bool is_row(const WideRow& row, std::uint64_t number) {
  for (const std::uint64_t value : row.values) {
    if (value != number) return false;
  }
  return true;
}

struct RingTest : testing::Test {
  void append(std::uint64_t first, std::uint64_t count, const std::atomic<std::uint64_t>* read = nullptr) {
    for (std::uint64_t i = 0; i < count; ++i) writer_.append(row_of(first + i), read);
  }

  AnonymousMemory<Ring<WideRow>> memory_;
  RingWriter<WideRow> writer_{memory_.get()};
  RingReader<WideRow> reader_{memory_.get()};
  WideRow row_;
};

TEST_F(RingTest, GivesEveryRowOnceAndInOrder) {
  append(0, 3);
  for (std::uint64_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(reader_.read(row_));
    EXPECT_TRUE(is_row(row_, i));
  }
  EXPECT_FALSE(reader_.read(row_));
  EXPECT_EQ(reader_.overwritten(), 0u);
}

TEST_F(RingTest, WrapsAround) {
  for (std::uint64_t i = 0; i < 3 * kRingRows + 5; ++i) {
    append(i, 1);
    ASSERT_TRUE(reader_.read(row_));
    ASSERT_TRUE(is_row(row_, i));
  }
}

TEST_F(RingTest, AReaderStartsAtTheRowThatComesNext) {
  append(0, 10);
  RingReader<WideRow> late(memory_.get());
  EXPECT_FALSE(late.read(row_));
  append(10, 1);
  ASSERT_TRUE(late.read(row_));
  EXPECT_TRUE(is_row(row_, 10));
}

TEST_F(RingTest, AReaderMayStartWhereAnEarlierOneEnded) {
  append(0, 10);
  RingReader<WideRow> successor(memory_.get(), 4);
  ASSERT_TRUE(successor.read(row_));
  EXPECT_TRUE(is_row(row_, 4));
}

TEST_F(RingTest, APositionOfAnotherObjectIsBroughtBack) {
  append(0, 10);
  RingReader<WideRow> other(memory_.get(), 5000);
  EXPECT_FALSE(other.read(row_));
  append(10, 1);
  ASSERT_TRUE(other.read(row_));
  EXPECT_TRUE(is_row(row_, 10));
}

TEST_F(RingTest, OverwritesTheOldestRowsWithoutAReaderAndTheNextReaderCountsThem) {
  append(0, kRingRows + 7);
  EXPECT_EQ(reader_.dropped(), 0u);
  ASSERT_TRUE(reader_.read(row_));
  EXPECT_TRUE(is_row(row_, 7));
  EXPECT_EQ(reader_.overwritten(), 7u);
}

TEST_F(RingTest, DropsAndCountsTheNewRowOfAFullRingWithAReader) {
  const std::atomic<std::uint64_t> read{0};
  append(0, kRingRows, &read);
  EXPECT_TRUE(writer_.full(&read));
  EXPECT_FALSE(writer_.append(row_of(kRingRows), &read));
  EXPECT_EQ(reader_.dropped(), 1u);
  ASSERT_TRUE(reader_.read(row_));
  EXPECT_TRUE(is_row(row_, 0));
}

TEST_F(RingTest, ARowTakenMakesRoomForOne) {
  std::atomic<std::uint64_t> read{0};
  append(0, kRingRows, &read);
  ASSERT_TRUE(reader_.read(row_));
  read.store(reader_.position());
  EXPECT_TRUE(writer_.append(row_of(kRingRows), &read));
  EXPECT_TRUE(writer_.full(&read));
}

TEST_F(RingTest, AReadPositionAheadOfTheRingIsNotFull) {
  const std::atomic<std::uint64_t> read{5000};  // left by the reader of another object
  EXPECT_FALSE(writer_.full(&read));
}

TEST_F(RingTest, ARowThatIsBeingOverwrittenIsSkippedAndCounted) {
  append(0, 3);
  memory_->slots[1].version.store(2 * kRingRows + 3);  // odd: row kRingRows + 1 is half written
  ASSERT_TRUE(reader_.read(row_));
  ASSERT_TRUE(reader_.read(row_));
  EXPECT_TRUE(is_row(row_, 2));
  EXPECT_EQ(reader_.overwritten(), 1u);
}

TEST_F(RingTest, AWriterKilledHalfWayLosesNoRowBeforeIt) {
  append(0, 3);
  memory_->slots[3].version.store(2 * 3 + 1);
  RingWriter<WideRow> successor(memory_.get());
  successor.append(row_of(33), nullptr);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(reader_.read(row_));
  EXPECT_TRUE(is_row(row_, 33));
  EXPECT_EQ(reader_.overwritten(), 0u);
}

TEST_F(RingTest, AppendAndTakeAllocateNothing) {
  AllocationGuard guard;
  append(0, 1);
  reader_.read(row_);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests
