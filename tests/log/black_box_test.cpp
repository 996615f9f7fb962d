#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "black_box_fixture.h"
#include "log/replay/replay.h"
#include "support/child_process.h"

namespace robot_control {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Every message of a log, as bits.
std::vector<std::string> messages_of(const std::string& bag) {
  std::vector<std::string> messages;
  BagReader reader(bag);
  for (const BagChunk& chunk : reader.chunks()) {
    reader.read(chunk, [&](const BagMessage& message) { messages.emplace_back(message.data); });
  }
  return messages;
}

TEST_F(ABlackBox, BecomesTheLogThatTelemetryWouldHaveWritten) {
  BlackBox box(path("ring"), kBytes, build_id(), header());
  drive_on(box, 2000);
  log->close();
  EXPECT_EQ(save().rows, 2000u);
  auto written = messages_of(path("log/run.bag")), saved = messages_of(path("saved/run.bag"));
  ASSERT_EQ(saved.size(), written.size());
  EXPECT_TRUE(std::equal(saved.begin() + 1, saved.end(), written.begin() + 1)) << "beside the header";
}

TEST_F(ABlackBox, HoldsTheNewestRowsOnceItIsFullAndTheyAreReplayedFromTheirFirstSnapshotOn) {
  BlackBox box(path("ring"), 8 << 20, build_id(), header());
  drive_on(box, 12000);
  save();
  const std::vector<std::uint64_t> cycles = cycles_of(path("saved/run.bag"));
  ASSERT_FALSE(cycles.empty());
  EXPECT_GT(cycles.front(), 0u) << "it is full";
  EXPECT_EQ(cycles.back(), 11999u);
  EXPECT_EQ(cycles.size(), cycles.back() - cycles.front() + 1) << "no gap";

  Replay replay(loop.robot(), drive_parameters().loop.period());
  TraceReader reader(path("saved/run.bag"));
  reader.read({.message =
                   [&](const TraceRow& row, const BagMessage& message) {
                     replay.add(row, message.data, static_cast<std::int64_t>(message.time_ns));
                   },
               .snapshot = [&](const LawSnapshot& snapshot) { replay.add(snapshot); }});
  EXPECT_EQ(replay.report().different_rows, 0u);
  for (const LawReport& law : replay.report().laws) {
    EXPECT_EQ(law.different, 0u);
    const std::uint64_t first = (cycles.front() + kSnapshotCycles - 1) / kSnapshotCycles * kSnapshotCycles;
    EXPECT_EQ(law.compared, 12'000u - first) << "from the first snapshot on";
  }
}

TEST_F(ABlackBox, IsSavedToOneNameByTwoProcessesAtOnce) {
  BlackBox box(path("ring"), kBytes, build_id(), header());
  drive_on(box, 3000);
  for (int trial = 0; trial < 5; ++trial) {
    ChildProcess other([this] { return save().rows == 3000u ? 0 : 1; });
    EXPECT_EQ(save().rows, 3000u);
    EXPECT_EQ(other.wait(), 0);
    EXPECT_EQ(cycles_of(path("saved/run.bag")).size(), 3000u);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("saved")), {}), 1) << "nothing is left beside it";
}

TEST_F(ABlackBox, LeavesNoBagWhereverTheCallerGivesUp) {
  BlackBox box(path("ring"), kBytes, build_id(), header());
  drive_on(box, 300);
  int asked = 0;
  save_black_box(path("ring"), build_id(), path("saved/run.bag"), [&] { return ++asked < 0; });
  std::filesystem::remove_all(path("saved"));
  ASSERT_GT(asked, 300);
  for (int last = 1; last <= asked; last += 1 + asked / 20) {
    int calls = 0;
    const auto give_up = [&] { return ++calls == last; };
    EXPECT_THROW(save_black_box(path("ring"), build_id(), path("saved/run.bag"), give_up), SavingGivenUp);
    EXPECT_EQ(calls, last) << "at once";
    EXPECT_FALSE(std::filesystem::exists(path("saved")));
  }
}

TEST_F(ABlackBox, OfAnotherBuildIsRefusedByItsName) {
  BlackBox box(path("ring"), kBytes, 0x0123456789abcdefU, header());
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("by the build 0123456789abcdef")));
  EXPECT_FALSE(std::filesystem::exists(path("saved")));
}

TEST_F(ABlackBox, IsNoOtherFile) {
  folder.write("ring", std::string(5 << 20, 'x'));
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("is no black box of this version")));
  folder.write("ring", "");
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("is no black box of this version")));
}

}  // namespace
}  // namespace robot_control
