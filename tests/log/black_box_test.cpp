#include <algorithm>
#include <filesystem>

#include "black_box_fixture.h"
#include "log/replay/replay.h"
#include "support/matchers.h"
#include "support/processes/child_process.h"

namespace robot_control::tests {

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
  BlackBox box(path("ring"), kBytes, header());
  drive_on(box, 2000);
  log->close();
  EXPECT_EQ(save().rows, 2000u);
  auto written = messages_of(path("log/run.bag")), saved = messages_of(path("saved/run.bag"));
  ASSERT_EQ(saved.size(), written.size());
  EXPECT_TRUE(std::equal(saved.begin() + 1, saved.end(), written.begin() + 1)) << "beside the header";
}

TEST_F(ABlackBox, HoldsTheNewestRowsOnceItIsFullAndTheyAreReplayedFromTheirFirstSnapshotOn) {
  BlackBox box(path("ring"), 4 << 20, header());
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
               .snapshot = [&](const LawSnapshot& snapshot, std::int64_t) { replay.add(snapshot); }});
  EXPECT_EQ(replay.report().different_rows, 0u);
  for (const LawReport& law : replay.report().laws) {
    EXPECT_EQ(law.different, 0u);
    const std::uint64_t first = (cycles.front() + kSnapshotCycles - 1) / kSnapshotCycles * kSnapshotCycles;
    EXPECT_EQ(law.compared, 12'000u - first) << "from the first snapshot on";
  }
}

TEST_F(ABlackBox, IsSavedToOneNameByTwoProcessesAtOnce) {
  BlackBox box(path("ring"), kBytes, header());
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
  BlackBox box(path("ring"), kBytes, header());
  drive_on(box, 300);
  int asked = 0;
  save_black_box(path("ring"), path("saved/run.bag"), [&] { return ++asked < 0; });
  std::filesystem::remove_all(path("saved"));
  ASSERT_GT(asked, 300);
  for (int last = 1; last <= asked; last += 1 + asked / 20) {
    int calls = 0;
    const auto give_up = [&] { return ++calls == last; };
    EXPECT_THROW(save_black_box(path("ring"), path("saved/run.bag"), give_up), SavingGivenUp);
    EXPECT_EQ(calls, last) << "at once";
    EXPECT_FALSE(std::filesystem::exists(path("saved")));
  }
}

/// A bag of rows that have one field.
TEST_F(ABlackBox, IsRefusedWithItsVersionIfThatIsAnother) {
  MessageType other = trace_type();
  other.definition = "uint64 cycle\n";
  const std::vector<WrittenConnection> connections{{.topic = "trace_header", .type = trace_header_type()},
                                                   {.topic = "trace", .type = other}};
  LogHeader written = header();
  written.version = "0.3.0";
  ChunkBuilder chunk;
  chunk.add_record(connection_records(connections));
  chunk.add(0, 1, encode(written));
  chunk.add(1, 2, std::string(8, '\0'));
  BagWriter(path("ring/0.bag"), connections, {}).write(chunk.pack(Effort::kFast));
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("was written by the version 0.3.0")));
  EXPECT_FALSE(std::filesystem::exists(path("saved")));
}

/// The estimator is dead: the others are not delayed for longer than BlackBox::kWindow.
TEST_F(ABlackBox, HoldsTheRowsOfTheOtherNodesWhereOneIsDead) {
  BlackBox box(path("ring"), kBytes, header());
  drive(loop, 1000, [&](const JoinedRow& row) {
    box.add(*row.driver);
    if (row.cycle < 500) box.add(*row.estimator);
    box.add(*row.controller);
    box.add(*row.monitor);
    box.flush();
  });
  save();
  EXPECT_EQ(cycles_of(path("saved/run.bag")).back(), 999u - 250u);
  box.finish();
  EXPECT_EQ(save().rows, 1000u);
}

TEST_F(ABlackBox, IsNothingElse) {
  folder.write("ring", std::string(5 << 20, 'x'));
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("is not a black box of this version")));
  std::filesystem::remove(path("ring"));
  std::filesystem::create_directories(path("ring"));
  folder.write("ring/run.bag", "");
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("is not a black box of this version")));
}

}  // namespace robot_control::tests
