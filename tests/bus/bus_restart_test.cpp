/// Tests the bus between processes that are killed and started again.

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "bus/bus.h"
#include "rt/clock.h"
#include "support/bus/scoped_bus.h"
#include "support/bus/test_frame.h"
#include "support/processes/anonymous_memory.h"
#include "support/processes/child_process.h"

namespace robot_control::tests {

using Frames = LatestFrames<TestFrame>;
constexpr std::int64_t kLong = 10'000'000'000;  // ns; a wait that ends this late was not woken

/// A writer in a process of its own has published cycle 5; the reader is here.
struct BusRestartTest : testing::Test {
  BusRestartTest() : writer_([this] { return write(5, true); }) {
    for (const std::int64_t end = monotonic_ns() + kLong; monotonic_ns() < end && !has_frame(5);) {
      channel_.poll();
      reader_.remap(channel_.memory());
      sleep_ns(1'000'000);
    }
  }

  void SetUp() override { ASSERT_TRUE(has_frame(5)); }

  int write(std::uint64_t cycle, bool stay) const {
    const OwnedChannel<Frames> channel(bus_.name(), ChannelNames::kState);
    TestFrame frame = test_frame(7, cycle);
    FrameWriter<TestFrame>(channel.memory()).publish(frame);
    while (stay) pause();
    return 0;
  }

  bool has_frame(std::uint64_t cycle) {
    TestFrame frame;
    return reader_.at(7, cycle, frame) == Lookup::kFrame;
  }

  ScopedBus bus_;
  ForeignChannel<Frames> channel_{bus_.name(), ChannelNames::kState};
  FrameReader<TestFrame> reader_;
  ChildProcess writer_;
};

TEST_F(BusRestartTest, AKilledWriterLeavesItsFramesAndSequenceToTheNext) {
  const std::uint32_t sequence = reader_.sequence();
  writer_.kill();
  EXPECT_FALSE(channel_.locked());
  const OwnedChannel<Frames> successor(bus_.name(), ChannelNames::kState);
  const FrameReader<TestFrame> own(successor.memory());
  TestFrame frame;
  ASSERT_EQ(own.newest(frame), Lookup::kFrame);
  EXPECT_EQ(frame.head.cycle, 5u);
  EXPECT_EQ(own.sequence(), sequence);
  EXPECT_FALSE(channel_.poll());  // the same object: readers notice nothing
  EXPECT_TRUE(channel_.locked());
}

TEST_F(BusRestartTest, AReaderThatWaitsIsWokenByTheNextWriter) {
  writer_.kill();
  const std::uint32_t seen = reader_.sequence();
  ChildProcess successor([this] {
    sleep_ns(50'000'000);
    return write(6, true);
  });
  const std::int64_t before_ns = monotonic_ns();
  EXPECT_TRUE(reader_.wait(seen, kLong));
  EXPECT_LT(monotonic_ns() - before_ns, kLong / 2);
  EXPECT_TRUE(has_frame(6));
  EXPECT_EQ(reader_.sequence(), seen + 1);
}

TEST_F(BusRestartTest, AReaderThatWaitsOnARetiredObjectGoesOnWithItsSuccessor) {
  std::uint64_t woken_by = 0;
  {
    writer_.kill();
    OwnedChannel<Frames>(bus_.name(), ChannelNames::kState).memory()->head.layout_version = kLayoutVersion + 1;
  }
  const std::uint32_t seen = reader_.sequence();
  std::thread waiting([&] {
    TestFrame frame;
    reader_.wait(seen, 3 * kLong);  // longer than the test may last
    if (reader_.newest(frame) == Lookup::kFrame) woken_by = frame.head.cycle;
  });
  const OwnedChannel<Frames> successor(bus_.name(), ChannelNames::kState);
  TestFrame frame = test_frame(8, 3);
  FrameWriter<TestFrame>(successor.memory()).publish(frame);
  EXPECT_TRUE(channel_.poll());
  reader_.remap(channel_.memory());
  waiting.join();
  EXPECT_EQ(woken_by, 3u);
}

/// Writers of one bus start at the same time, each in a process.
class Race {
 public:
  Race() {
    for (int i = 0; i < kWriters; ++i) writers_.push_back(std::make_unique<ChildProcess>([this] { return write(); }));
  }

  int winners() {
    int winners = 0;
    for (const auto& writer : writers_) winners += writer->wait() == 0 ? 1 : 0;
    return winners;
  }

 private:
  static constexpr int kWriters = 4;

  int write() const {
    std::optional<OwnedChannel<Frames>> channel;
    try {
      channel.emplace(bus_.name(), ChannelNames::kState);
    } catch (const BusError&) {
    }
    tried_->fetch_add(1);
    while (tried_->load() < kWriters) sleep_ns(100'000);  // the winner holds it until all have tried
    return channel ? 0 : 1;
  }

  const ScopedBus bus_;
  const AnonymousMemory<std::atomic<int>> tried_;
  std::vector<std::unique_ptr<ChildProcess>> writers_;
};

// A refused writer has waited for the lock, so ten races run at a time.
TEST(BusRace, LetsOneOfManyWritersWinAndRefusesTheOthers) {
  for (int round = 0; round < 5; ++round) {
    std::vector<std::unique_ptr<Race>> races;
    for (int i = 0; i < 10; ++i) races.push_back(std::make_unique<Race>());
    for (const auto& race : races) ASSERT_EQ(race->winners(), 1) << "round " << round;
  }
}

}  // namespace robot_control::tests
