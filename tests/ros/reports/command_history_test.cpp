#include <gtest/gtest.h>

#include "ros/nodes/commanded_node.h"

namespace robot_control::tests {

/// A controller that publishes every cycle, and a thread that reads now and then.
struct CommandHistoryTest : testing::Test {
  void publish(std::uint64_t reasons, std::uint64_t run = 7, std::uint64_t risers = 0, std::uint64_t reaches = 0) {
    newest_.head = {.run = run, .cycle = cycle_++};
    newest_.reasons = reasons;
    newest_.legged.risers = risers;
    newest_.legged.reaches = reaches;
    writer_.publish(newest_);
  }

  CommandReports collect() { return history_.collect(FrameReader<CommandFrame>(memory_.get()), newest_); }
  std::uint64_t poll() { return collect().reasons; }

  std::unique_ptr<LatestFrames<CommandFrame>> memory_ = std::make_unique<LatestFrames<CommandFrame>>();
  FrameWriter<CommandFrame> writer_{memory_.get(), Wake::kNone};
  CommandHistory history_;
  CommandFrame newest_;
  std::uint64_t cycle_ = 100;
};

TEST_F(CommandHistoryTest, FindsAReasonOfOneCycleBetweenTwoLooks) {
  publish(0);
  EXPECT_EQ(poll(), 0u);
  publish(0);
  publish(kReasonJerkYielded);
  publish(0);
  publish(kReasonSaturated);
  EXPECT_EQ(poll(), std::uint64_t{kReasonJerkYielded} | kReasonSaturated);
  publish(0);
  EXPECT_EQ(poll(), 0u) << "reported once";
}

TEST_F(CommandHistoryTest, FindsFeetThatMetARiserOrNoGroundForOneCycle) {
  publish(0);
  poll();
  publish(0, 7, 1, 4);
  publish(0, 7, 2, 0);
  publish(0);
  const CommandReports reports = collect();
  EXPECT_EQ(reports.risers, 3u);
  EXPECT_EQ(reports.reaches, 4u);
}

TEST_F(CommandHistoryTest, GoesBackAsFarAsTheChannelDoes) {
  publish(0);
  poll();
  publish(kReasonRefused);
  for (std::size_t i = 0; i < kFrameSlots; ++i) publish(0);
  EXPECT_EQ(poll(), 0u) << "that slot was used again";
  publish(kReasonRefused);
  for (std::size_t i = 1; i < kFrameSlots; ++i) publish(0);
  EXPECT_EQ(poll(), kReasonRefused);
}

TEST_F(CommandHistoryTest, RestartsWithARun) {
  publish(0);
  poll();
  publish(kReasonRefused);
  publish(kReasonHolding, 8);
  EXPECT_EQ(poll(), kReasonHolding);
}

}  // namespace robot_control::tests
