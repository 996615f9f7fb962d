/// Runs the code of Ring itself, with two slots and rows of two words, in every execution of a writer and a reader. The
/// executions are those that the memory model of C++ allows.

#include "bus/model/expectations.h"
#include "bus/model/futex_stub.h"
#include "bus/ring.h"

namespace robot_control::model::tests {

constexpr std::size_t kRows = 2;

/// Both words are the row's position.
struct Row {
  std::uint64_t first = 0;
  std::uint64_t second = 0;
};

struct RingModelTest : testing::Test {
  RingModelTest() {
    model_.name(ring_.written.word(), "written");
    model_.name(ring_.dropped.word(), "dropped");
    for (const auto& slot : ring_.slots) {
      model_.name(slot.version.word(), "version");
      for (const auto& word : slot.words) model_.name(word.word(), "words");
    }
    model_.name(read_.word(), "read");
    model_.second_writes(read_.word());
    model_.second_writes(asked_.word());
  }

  using Reader = RingReader<Row, ModelAtomic, kRows>;

  /// Takes a row, which must be that of the reader's position.
  bool take_next(Reader& reader) {
    Row row;
    if (!reader.read(row)) return false;
    if (row.first != row.second) model_.fail("torn");
    if (row.first + 1 != reader.position()) model_.fail("reordered");
    ++taken_;
    return true;
  }

  /// The writer does not know which rows were read.
  Report rows_overwritten(std::uint64_t rows) {
    return explore(rows, nullptr, [this](Reader& reader) {
      for (int i = 0; i < 3; ++i) take_next(reader);
    });
  }

  /// The reader publishes its position; the writer drops rows without room.
  Report rows_dropped(std::uint64_t rows) {
    return explore(rows, &read_, [this](Reader& reader) {
      for (int i = 0; i < 3; ++i) {
        if (take_next(reader)) read_.store(reader.position(), std::memory_order_release);
      }
      if (reader.overwritten() != 0) model_.fail("overwritten before it was read");
    });
  }

  /// The writer is killed anywhere in its second row, whose place its successor fills.
  Report rows_of_a_killed_writer() {
    return model_.explore(
        [this] {
          writer_.append({0, 0}, nullptr);
          model_.mortal();
          writer_.append({1, 1}, nullptr);
          model_.revive();
          const std::uint64_t next = ring_.written.load(std::memory_order_relaxed);
          writer_.append({next, next}, nullptr);
        },
        [this] {
          reader_.emplace(&ring_, 0);
          for (int i = 0; i < 2; ++i) take_next(*reader_);
        });
  }

  /// A row that is known to be written is found.
  Report row_that_was_told_of() {
    return model_.explore(
        [this] {
          writer_.append({0, 0}, nullptr);
          told_.store(1, std::memory_order_release);
        },
        [this] {
          reader_.emplace(&ring_, 0);
          const bool found = take_next(*reader_);
          if (told_.load(std::memory_order_acquire) == 1 && !found && !take_next(*reader_)) model_.fail("not found");
        });
  }

  /// A row that is known to be read has made room.
  Report room_that_was_told_of() {
    return model_.explore(
        [this] {
          for (std::uint64_t i = 0; i < kRows; ++i) writer_.append({i, i}, &read_);
          const bool fits = writer_.append({kRows, kRows}, &read_);
          if (asked_.load(std::memory_order_acquire) == 1 && !fits && !writer_.append({kRows, kRows}, &read_)) {
            model_.fail("no room");
          }
        },
        [this] {
          reader_.emplace(&ring_, 0);
          if (!take_next(*reader_)) return;
          read_.store(reader_->position(), std::memory_order_release);
          asked_.store(1, std::memory_order_release);
        });
  }

  template <class Look>
  Report explore(std::uint64_t rows, const ModelAtomic<std::uint64_t>* read, Look look) {
    return model_.explore(
        [this, rows, read] {
          std::uint64_t position = 0;
          for (std::uint64_t i = 0; i < rows; ++i) {
            if (writer_.append({position, position}, read)) ++position;
          }
        },
        [this, look] {
          taken_ = 0;
          reader_.emplace(&ring_, 0);
          look(*reader_);
        },
        [this, rows] {
          for (std::uint64_t i = 0; i < rows; ++i) take_next(*reader_);
          if (taken_ + reader_->overwritten() + reader_->dropped() != rows) model_.fail("miscounted");
        });
  }

  MemoryModel model_;
  Ring<Row, ModelAtomic, kRows> ring_;
  ModelAtomic<std::uint64_t> read_, told_, asked_;
  RingWriter<Row, ModelAtomic, kRows> writer_{&ring_};
  std::optional<Reader> reader_;
  std::uint64_t taken_ = 0;
};

TEST_F(RingModelTest, RowsOverwrittenAreNeverTornAndEachIsTakenOrCounted) {
  expect_no_violation(rows_overwritten(4));
}

TEST_F(RingModelTest, RowsThatFindNoRoomAreDroppedAndCountedAndNoneIsOverwritten) {
  expect_no_violation(rows_dropped(4));
}

TEST_F(RingModelTest, AWriterKilledAnywhereLeavesNoTornRow) {
  expect_no_violation(rows_of_a_killed_writer());
}

TEST_F(RingModelTest, WhatIsKnownToBeWrittenIsFoundAndWhatIsKnownToBeReadMakesRoom) {
  expect_no_violation(row_that_was_told_of());
  expect_no_violation(room_that_was_told_of());
}

TEST_F(RingModelTest, EveryOrderAndEveryCheckIsNeeded) {
  // The writer acquires `read` to keep its stores behind the reader's loads; the model never exchanges these.
  EXPECT_EQ(unnoticed(model_, "ring.h",
                      {[this] { return row_that_was_told_of(); }, [this] { return room_that_was_told_of(); },
                       [this] { return rows_overwritten(4); }, [this] { return rows_dropped(4); },
                       [this] { return rows_of_a_killed_writer(); }}),
            std::set<std::string>{"load-acquire read #1 without order"});
  EXPECT_GE(model_.mutants("ring.h").size(), 10u);
}

}  // namespace robot_control::model::tests
