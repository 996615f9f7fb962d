/// Readers on damaged memory end, stay within the memory, and accept no frame that its writer did not seal.

#include <gtest/gtest.h>

#include <cstring>
#include <span>

#include "bus/latest_frames.h"
#include "bus/ring.h"
#include "support/bus/damage.h"
#include "support/bus/test_frame.h"

namespace robot_control::tests {

constexpr std::uint64_t kMutants = 100'000;
constexpr std::uint64_t kDamagedRun = 7;
constexpr std::uint64_t kCycles = 10;

template <class Object>
std::span<std::byte> bytes_of(Object& object) {
  return {reinterpret_cast<std::byte*>(&object), sizeof object};
}

/// Cycles 0 … 9 were published; a copy of that is damaged. It lies on the heap, where the address sanitizer detects an
/// access beyond its end.
struct DamagedFrames : testing::Test {
  using Frames = LatestFrames<TestFrame>;

  DamagedFrames() {
    FrameWriter<TestFrame> writer(healthy_.get());
    for (std::uint64_t cycle = 0; cycle < kCycles; ++cycle) {
      TestFrame frame = test_frame(kDamagedRun, cycle);
      writer.publish(frame);
    }
  }

  void heal() { std::memcpy(static_cast<void*>(damaged_.get()), healthy_.get(), sizeof(Frames)); }

  bool is_frame(Lookup found) const { return found == Lookup::kFrame || found == Lookup::kToken; }

  /// Calls `check` with each frame that a look-up returned.
  template <class Check>
  void check_frames(Damage& damage, Check check) {
    TestFrame frame;
    if (is_frame(reader_.newest(frame))) check(frame);
    for (const std::uint64_t cycle : {kCycles - 1, kCycles - kFrameSlots, damage.number()}) {
      const std::uint64_t run = damage.below(4) == 0 ? damage.number() : kDamagedRun;
      if (!is_frame(reader_.at(run, cycle, frame))) continue;
      EXPECT_EQ(frame.head.run, run);
      EXPECT_EQ(frame.head.cycle, cycle);
      check(frame);
    }
    const std::uint64_t first = damage.number();
    const std::uint64_t last = damage.number();
    if (!is_frame(reader_.newest_within(kDamagedRun, first, last, frame))) return;
    EXPECT_GE(frame.head.cycle, first);
    EXPECT_LE(frame.head.cycle, last);
    check(frame);
  }

  std::unique_ptr<Frames> healthy_ = std::make_unique<Frames>();
  std::unique_ptr<Frames> damaged_ = std::make_unique<Frames>();
  FrameReader<TestFrame> reader_{damaged_.get()};
};

TEST_F(DamagedFrames, NothingIsTakenForAFrameThatWasNotPublished) {
  std::uint64_t accepted = 0;
  for (std::uint64_t seed = 0; seed < kMutants && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Damage damage(seed);
    heal();
    damage.strike(bytes_of(*damaged_));
    check_frames(damage, [&](const TestFrame& frame) {
      ++accepted;
      EXPECT_TRUE(intact(frame));
      EXPECT_TRUE(whole(frame));
      EXPECT_EQ(frame.head.run, kDamagedRun);
    });
  }
  EXPECT_GT(accepted, kMutants / 2);  // most damage leaves most frames alone
}

TEST_F(DamagedFrames, HeadsThatLookRightOverWrongContentAreCorrupt) {
  for (std::uint64_t seed = 0; seed < kMutants && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Damage damage(seed);
    heal();
    auto& slot = damaged_->slots[(kCycles - 1) % kFrameSlots];
    const std::size_t word = sizeof(FrameHead) / 8 + damage.below(100);
    const std::uint64_t flipped = std::uint64_t{1} << damage.below(64);
    slot.words[word].fetch_xor(flipped);
    TestFrame frame;
    EXPECT_EQ(reader_.newest(frame), Lookup::kCorrupt);
    EXPECT_EQ(reader_.at(kDamagedRun, kCycles - 1, frame), Lookup::kCorrupt);
  }
}

TEST_F(DamagedFrames, AFrameOfNoKnownKindIsCorrupt) {
  FrameWriter<TestFrame> writer(damaged_.get());
  TestFrame frame = test_frame(kDamagedRun, 3);
  frame.head.kind = static_cast<FrameKind>(3);
  writer.publish(frame);
  EXPECT_EQ(reader_.newest(frame), Lookup::kCorrupt);
}

TEST_F(DamagedFrames, TheNextPublicationIsFoundWhateverLayThere) {
  for (std::uint64_t seed = 0; seed < kMutants / 10 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Damage damage(seed);
    heal();
    damage.strike(bytes_of(*damaged_));
    TestFrame frame = test_frame(kDamagedRun, kCycles);
    FrameWriter<TestFrame>(damaged_.get(), Wake::kNone).publish(frame);
    TestFrame found;
    ASSERT_EQ(reader_.newest(found), Lookup::kFrame);
    EXPECT_EQ(found.head.cycle, kCycles);
  }
}

struct SmallRow {
  std::array<std::uint64_t, 4> values{};
};

TEST(DamagedRing, AReaderEndsAndAfterTheNextRowsItIsInStepAgain) {
  constexpr std::size_t kRows = 16;
  using Rows = Ring<SmallRow, std::atomic, kRows>;
  const auto memory = std::make_unique<Rows>();
  for (std::uint64_t seed = 0; seed < kMutants && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Damage damage(seed);
    damage.strike(bytes_of(*memory));
    RingReader<SmallRow, std::atomic, kRows> reader(memory.get(), damage.number());
    RingWriter<SmallRow, std::atomic, kRows> writer(memory.get());
    SmallRow row;
    for (std::size_t i = 0; i < 2 * kRows; ++i) reader.read(row);
    for (std::size_t i = 0; i < kRows; ++i) writer.append({}, nullptr);
    for (std::size_t i = 0; i < 2 * kRows; ++i) reader.read(row);
    writer.append({{seed, seed, seed, seed}}, nullptr);
    ASSERT_TRUE(reader.read(row));
    EXPECT_EQ(row.values[3], seed);
    EXPECT_FALSE(reader.read(row));
  }
}

}  // namespace robot_control::tests
