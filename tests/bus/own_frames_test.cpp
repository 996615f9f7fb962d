#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "bus/latest_frames.h"

namespace robot_control::tests {

struct SmallFrame {
  FrameHead head;
  std::uint64_t content = 0;
};

/// The same publications into shared memory and into the frames of one thread.
struct OwnFramesTest : testing::Test {
  using Memory = LatestFrames<SmallFrame>;
  std::unique_ptr<Memory> shared_ = std::make_unique<Memory>();
  std::unique_ptr<Memory> memory_ = std::make_unique<Memory>();
  std::unique_ptr<OwnFrames<SmallFrame>> own_ = std::make_unique<OwnFrames<SmallFrame>>();
  FrameWriter<SmallFrame> shared_writer_{shared_.get(), Wake::kNone};
  FrameWriter<SmallFrame> own_writer_{memory_.get(), own_.get()};
  FrameReader<SmallFrame> shared_reader_{shared_.get()};
  FrameReader<SmallFrame> own_reader_{memory_.get(), own_.get()};

  template <class Act>
  void both(Act act) {
    act(shared_writer_);
    act(own_writer_);
  }
};

TEST_F(OwnFramesTest, RandomPublicationsAreFoundAsInSharedMemory) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::uint64_t cycle = 0;
    for (int i = 0; i < 50; ++i) {
      cycle += random() % 3;
      const std::uint64_t content = random();
      const FrameHead head{.run = 1 + random() % 2, .cycle = cycle, .stamp_ns = 5};
      const unsigned act = random() % 4;
      both([&](FrameWriter<SmallFrame>& writer) {
        SmallFrame frame{.head = head, .content = content};
        if (act == 0) return writer.publish_token(head);
        if (act > 1) return writer.publish(frame);
        seal(frame);
        if (content % 2 == 0) ++frame.content;  // broken
        writer.publish_sealed(frame);
      });
      for (std::uint64_t run = 1; run < 3; ++run) {
        SmallFrame one, other;
        EXPECT_EQ(shared_reader_.newest(one), own_reader_.newest(other)) << "seed " << seed;
        EXPECT_EQ(one.head.cycle, other.head.cycle) << "seed " << seed;
        for (std::uint64_t back = 0; back < 4; ++back) {
          const std::uint64_t asked = cycle - std::min(cycle, back);
          const Lookup found = shared_reader_.at(run, asked, one);
          const Found<SmallFrame> view = own_reader_.find_at(run, asked, other);
          ASSERT_EQ(found, view.lookup) << "seed " << seed;
          if (found == Lookup::kFrame) {
            EXPECT_EQ(one.content, view.frame->content) << "seed " << seed;
          }
        }
        const std::uint64_t first = cycle - std::min<std::uint64_t>(cycle, 4);
        EXPECT_EQ(shared_reader_.newest_within(run, first, cycle, one),
                  own_reader_.newest_within(run, first, cycle, other))
            << "seed " << seed;
      }
    }
  }
}

TEST_F(OwnFramesTest, AFoundFrameIsWhereItsWriterHasPutIt) {
  SmallFrame frame{.head = {.run = 1, .cycle = 3}, .content = 7};
  own_writer_.publish_in_place(frame);
  SmallFrame buffer;
  const Found<SmallFrame> found = own_reader_.find_newest(buffer);
  EXPECT_EQ(found.lookup, Lookup::kFrame);
  EXPECT_EQ(found.frame, &frame);
}

TEST_F(OwnFramesTest, AFrameInWhosePlaceALaterOneStandsIsMissing) {
  own_->kept = 2;
  ASSERT_EQ(own_writer_.kept(), 2u);
  std::array<SmallFrame, 2> places;
  for (std::uint64_t cycle = 3; cycle < 6; ++cycle) {
    places[cycle % 2] = {.head = {.run = 1, .cycle = cycle}, .content = cycle};
    own_writer_.publish_in_place(places[cycle % 2]);
  }
  SmallFrame buffer;
  EXPECT_EQ(own_reader_.find_at(1, 3, buffer).lookup, Lookup::kMissing);
  EXPECT_EQ(own_reader_.find_at(1, 4, buffer).frame->content, 4u);
  EXPECT_EQ(own_reader_.find_at(1, 5, buffer).frame->content, 5u);
  EXPECT_EQ(own_reader_.find_within(1, 3, 3, buffer).lookup, Lookup::kMissing);
}

TEST_F(OwnFramesTest, ACopyHoldsTheFramesItself) {
  SmallFrame frame{.head = {.run = 1, .cycle = 3}, .content = 7};
  own_writer_.publish_in_place(frame);
  const OwnFrames<SmallFrame> copy(*own_);
  frame.content = 8;
  EXPECT_EQ(copy.slots[3].frame->content, 7u);
  EXPECT_EQ(copy.slots[3].frame, &copy.slots[3].stored);
}

TEST_F(OwnFramesTest, FramesHaveChecksumsFromTheMomentOnInWhichTheyAreNeeded) {
  SmallFrame frame{.head = {.run = 1, .cycle = 3}, .content = 7};
  own_writer_.publish_in_place(frame);
  EXPECT_EQ(frame.head.checksum, 0u);
  own_->seal_all();
  EXPECT_TRUE(intact(frame));
  SmallFrame next{.head = {.run = 1, .cycle = 4}, .content = 9};
  own_writer_.publish(next);
  EXPECT_TRUE(intact(next));
}

TEST_F(OwnFramesTest, FindsNothingBeforeTheFirstPublication) {
  SmallFrame buffer;
  EXPECT_EQ(own_reader_.find_newest(buffer).lookup, Lookup::kMissing);
  EXPECT_EQ(own_reader_.find_at(1, 0, buffer).lookup, Lookup::kMissing);
  EXPECT_EQ(own_reader_.last_whole(buffer), Lookup::kMissing);
}

}  // namespace robot_control::tests
