/// Runs the code of LatestFrames itself, with two slots and frames of five words, in every execution of a writer and a
/// reader. The executions are those that the memory model of C++ allows. A reader writes nothing, so the result for one
/// reader holds for all.

#include "bus/latest_frames.h"
#include "bus/model/expectations.h"
#include "bus/model/futex_stub.h"

namespace robot_control::model::tests {

constexpr std::size_t kSlots = 2;
constexpr std::uint64_t kRun = 7;

/// stamp_ns is the number of the publication, from 1.
struct Frame {
  FrameHead head;
};

/// Publication 1, of cycle 1, exists before a reader starts.
struct LatestFramesModelTest : testing::Test {
  LatestFramesModelTest() {
    model_.name(frames_.sequence.word(), "sequence");
    model_.name(frames_.newest.word(), "newest");
    for (const auto& slot : frames_.slots) {
      model_.name(slot.version.word(), "version");
      for (const auto& word : slot.words) model_.name(word.word(), "words");
    }
    publish(1, 1);
  }

  void publish(std::int64_t number, std::uint64_t cycle, std::uint64_t run = kRun) {
    Frame frame;
    frame.head.run = run;
    frame.head.cycle = cycle;
    frame.head.stamp_ns = number;
    writer_.publish(frame);
  }

  /// The number of the publication that the reader finds; 0: none. Fails on a torn frame.
  std::int64_t newest() {
    Frame frame;
    const Lookup found = reader_.newest(frame);
    if (found == Lookup::kCorrupt) model_.fail("torn");
    return found == Lookup::kFrame ? frame.head.stamp_ns : 0;
  }

  enum class Finds { kAlways, kPerhaps };

  /// Reads twice, after publication 1 is known.
  void look_twice(Finds finds) {
    const std::int64_t first = newest();
    const std::int64_t second = newest();
    if (finds == Finds::kAlways && (first == 0 || second == 0)) model_.fail("not found");
    if (second != 0 && second < first) model_.fail("back");
  }

  /// The state when writer and reader are at rest.
  MemoryModel::Body rest(std::int64_t published, std::uint32_t sequence) {
    return [this, published, sequence] {
      if (newest() != published) model_.fail("the last publication is not the newest");
      if (reader_.sequence() != sequence) model_.fail("miscounted");
    };
  }

  Report two_looks_during(std::int64_t publications) {
    return model_.explore(
        [this, publications] {
          for (std::int64_t n = 2; n <= 1 + publications; ++n) publish(n, static_cast<std::uint64_t>(n));
        },
        [this] { look_twice(Finds::kAlways); }, rest(1 + publications, static_cast<std::uint32_t>(1 + publications)));
  }

  /// Cycles 1 and 3 share a slot: the newest slot is being written. Then a new run begins.
  Report two_looks_while_cycles_are_skipped() {
    return model_.explore(
        [this] {
          publish(2, 3);
          publish(3, 0, kRun + 1);
        },
        [this] { look_twice(Finds::kPerhaps); }, rest(3, 3));
  }

  /// Its successor publishes the same cycle again.
  Report two_looks_while_the_writer_is_killed() {
    return model_.explore(
        [this] {
          model_.mortal();
          publish(2, 2);
          model_.revive();
          publish(3, 2);
        },
        [this] { look_twice(Finds::kPerhaps); },
        [this] {
          if (newest() != 3) model_.fail("the last publication is not the newest");
        });
  }

  /// A reader that read `sequence` finds that publication or a later one: it may sleep until the next.
  Report look_after_a_wake_up() {
    return model_.explore(
        [this] {
          for (std::int64_t n = 2; n <= 4; ++n) publish(n, static_cast<std::uint64_t>(n));
        },
        [this] {
          const std::int64_t published = reader_.sequence();
          if (newest() < published) model_.fail("a wake-up without its frame");
        });
  }

  /// A frame known to be published is found by its cycle until the slot's next publication has begun.
  Report look_by_cycle() {
    return model_.explore(
        [this] {
          publish(2, 2);
          publish(3, 3);
        },
        [this] {
          const std::uint64_t published = reader_.sequence();
          Frame frame;
          for (const std::uint64_t cycle : {published, published - 1}) {
            const Lookup found = reader_.at(kRun, cycle, frame);
            if (found == Lookup::kCorrupt) model_.fail("torn");
            const bool right = frame.head.run == kRun && frame.head.cycle == cycle;
            if (found == Lookup::kFrame && !right) model_.fail("another cycle");
            if (found == Lookup::kMissing && cycle >= 2) model_.fail("not found");
          }
        });
  }

  MemoryModel model_;
  LatestFrames<Frame, ModelAtomic, kSlots> frames_;
  FrameWriter<Frame, ModelAtomic, kSlots> writer_{&frames_, Wake::kNone};
  FrameReader<Frame, ModelAtomic, kSlots> reader_{&frames_};
};

TEST_F(LatestFramesModelTest, NoFrameIsTornAndNoneIsOlderThanTheOneBefore) {
  expect_no_violation(two_looks_during(kReadTries - 1));
}

TEST_F(LatestFramesModelTest, AReaderThatFindsNothingWasOvertakenByAsManyPublicationsAsItTried) {
  EXPECT_EQ(two_looks_during(kReadTries).violation, "not found");
}

TEST_F(LatestFramesModelTest, SkippedCyclesAndANewRunTurnNothingBack) {
  expect_no_violation(two_looks_while_cycles_are_skipped());
}

TEST_F(LatestFramesModelTest, AWriterKilledAnywhereAndItsSuccessorTearNothing) {
  expect_no_violation(two_looks_while_the_writer_is_killed());
}

TEST_F(LatestFramesModelTest, AWakeUpComesWithItsFrame) {
  expect_no_violation(look_after_a_wake_up());
}

TEST_F(LatestFramesModelTest, APublishedCycleIsFoundUntilItsSlotIsUsedAgain) {
  expect_no_violation(look_by_cycle());
}

TEST_F(LatestFramesModelTest, EveryOrderAndEveryCheckIsNeeded) {
  EXPECT_EQ(unnoticed(model_, "latest_frames.h",
                      {[this] { return look_after_a_wake_up(); }, [this] { return look_by_cycle(); },
                       [this] { return two_looks_during(kReadTries - 1); },
                       [this] { return two_looks_while_cycles_are_skipped(); },
                       [this] { return two_looks_while_the_writer_is_killed(); }}),
            std::set<std::string>{});
  EXPECT_GE(model_.mutants("latest_frames.h").size(), 15u);
}

}  // namespace robot_control::model::tests
