#include "log/bag_log.h"

#include <filesystem>

#include "log/log_error.h"
#include "log/trace_reader.h"
#include "loop/log_header.h"
#include "recorded_drive.h"
#include "support/matchers.h"
#include "support/recorded_loop.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct Found {
  std::vector<std::uint64_t> cycles = {};
  std::vector<std::uint64_t> lost = {};
  std::size_t snapshots = 0;
  std::string cut;
};

/// Rows that are read while the file is checked, and again afterwards.
Found rows_of(const std::string& path) {
  Found found, again;
  const auto into = [](Found& to) -> TraceReader::Use {
    return {.row =
                [&](const TraceRow& row, std::int64_t) {
                  to.cycles.push_back(row.cycle);
                  to.lost.push_back(row.lost);
                },
            .snapshot =
                [&](const LawSnapshot& snapshot, std::int64_t) {
                  EXPECT_TRUE(intact(snapshot));
                  ++to.snapshots;
                }};
  };
  TraceReader reader(path, into(found));
  reader.read(into(again));
  EXPECT_EQ(found.cycles, again.cycles);
  EXPECT_EQ(found.lost, again.lost);
  EXPECT_EQ(found.snapshots, again.snapshots);
  found.cut = reader.cut();
  return found;
}

struct ABagLog : testing::Test {
  ABagLog() { parameters.telemetry.record = RecordMode::kAlways; }

  BagLog& open(const TelemetryParameters& telemetry) {
    log.reset();  // it refers to its folder
    logs = std::make_unique<LogFolder>(folder.path() / "log", static_cast<std::int64_t>(telemetry.quota * 1e9));
    log = std::make_unique<BagLog>(*logs, log_header(parameters, loop.robot()), telemetry);
    return *log;
  }
  BagLog& open() { return open(parameters.telemetry); }

  void drive_on(std::uint64_t cycles) {
    drive(loop, cycles, [&](const JoinedRow& row) {
      for (const LawSnapshot* snapshot : loop.snapshots()) {
        if (snapshot != nullptr) log->write(*snapshot);
      }
      log->write(row);
    });
  }
  void stand(std::uint64_t cycles) {
    loop.command({});
    for (std::uint64_t i = 0; i < cycles; ++i) {
      loop.step();
      log->write(loop.row());
    }
  }
  std::string path(const std::string& name = "run.bag") const { return folder.path() / "log" / name; }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "log")) {
      found.push_back(entry.path().filename());
    }
    std::ranges::sort(found);
    return found;
  }

  Parameters parameters = drive_parameters();
  RecordedLoop loop{parameters};
  TemporaryFolder folder;
  std::unique_ptr<LogFolder> logs;
  std::unique_ptr<BagLog> log;
};

TEST_F(ABagLog, HoldsEveryRowAndSnapshotAndItsHeader) {
  open();
  drive_on(2500);
  log->close();
  EXPECT_EQ(log->rows(), 2500u);
  TraceReader reader(path());
  EXPECT_EQ(reader.header().robot, "diffbot");
  EXPECT_THAT(reader.header().joints, ElementsAre("left_wheel_joint", "right_wheel_joint"));
  EXPECT_EQ(reader.header().period, 0.001);
  EXPECT_EQ(reader.header().urdf, loop.robot().machine().urdf);
  const Found found = rows_of(path());
  ASSERT_EQ(found.cycles.size(), 2500u);
  for (std::uint64_t k = 0; k < 2500; ++k) ASSERT_EQ(found.cycles[k], k);
  EXPECT_EQ(found.snapshots, (2 + 2500 / kSnapshotCycles) * kLaws) << "of the first two cycles, and then regularly";
  EXPECT_EQ(found.cut, "");
}

TEST_F(ABagLog, IsReadToItsLastChunkIfItsWriterWasKilled) {
  open();
  drive_on(2500);
  const Found found = rows_of(path());
  EXPECT_NEAR(static_cast<double>(found.cycles.size()), 2000, 1) << "two chunks of a second";
  EXPECT_THAT(found.cut, HasSubstr("has no end"));
}

TEST_F(ABagLog, HoldsMotionAndWhatWasBeforeIt) {
  parameters.telemetry.record = RecordMode::kMotion;
  open();
  stand(20'000);
  EXPECT_FALSE(log->recording());
  const std::uint64_t begin = loop.cycle();
  drive_on(1000);
  EXPECT_TRUE(log->recording());
  stand(20'000);
  log->close();
  const Found found = rows_of(path());
  std::uint64_t gaps = 0;
  for (std::size_t i = 1; i < found.cycles.size(); ++i) gaps += found.cycles[i] != found.cycles[i - 1] + 1;
  EXPECT_LE(gaps, 1u) << "at most between the start and the drive";
  const auto before = static_cast<std::uint64_t>(BagLog::kBeforeNs / 1'000'000);
  EXPECT_TRUE(std::ranges::binary_search(found.cycles, begin - before + 1000)) << "eleven seconds before";
  EXPECT_TRUE(std::ranges::binary_search(found.cycles, begin + 1000 + 5000)) << "five seconds after";
  EXPECT_FALSE(std::ranges::binary_search(found.cycles, loop.cycle() - 1));
  EXPECT_EQ(log->unwritten(), 0u);
}

// A replay begins at a snapshot.
TEST_F(ABagLog, HoldsASnapshotAtAnyRate) {
  for (const double rate : {20.0, 50.0, 100.0, 1000.0})
    EXPECT_GE(BagLog::before_ns(1 / rate), 1e9 * (static_cast<double>(kSnapshotCycles) / rate + 1)) << rate;
  EXPECT_EQ(BagLog::before_ns(0.001), BagLog::kBeforeNs);
}

TEST_F(ABagLog, HoldsWhatIsRequested) {
  parameters.telemetry.record = RecordMode::kRequest;
  open();
  drive_on(20'000);
  EXPECT_EQ(log->rows(), 0u);
  log->request(true);
  stand(1000);
  log->request(false);
  stand(5000);
  log->close();
  EXPECT_THAT(log->rows(), AllOf(testing::Ge(12'000u), testing::Le(16'000u)));
}

TEST_F(ABagLog, IsSplitBySizeAndLosesNothing) {
  parameters.telemetry.split_size = 0.002;
  open();
  drive_on(25'000);
  log->close();
  std::vector<std::uint64_t> cycles;
  std::vector<std::string> parts = names();  // run.1.bag, run.2.bag, …, run.bag
  EXPECT_GE(parts.size(), 3u);
  std::uint32_t number = 0;
  for (const std::string& part : parts) {
    EXPECT_EQ(TraceReader(path(part)).header().part, number++) << part;
    const Found found = rows_of(path(part));
    cycles.insert(cycles.end(), found.cycles.begin(), found.cycles.end());
    EXPECT_LE(std::filesystem::file_size(path(part)), 10'000'000u);
  }
  ASSERT_EQ(cycles.size(), 25'000u);
  for (std::uint64_t k = 0; k < cycles.size(); ++k) ASSERT_EQ(cycles[k], k);
}

TEST_F(ABagLog, IsSplitByTimeInFrontOfTheSnapshotsOfAllLaws) {
  parameters.telemetry.split_time = 2;
  open();
  drive_on(7'000);
  log->close();
  ASSERT_THAT(names(), ElementsAre("run.1.bag", "run.2.bag", "run.3.bag", "run.bag"));
  for (const char* name : {"run.2.bag", "run.3.bag", "run.bag"}) {
    const Found found = rows_of(path(name));
    const std::uint64_t behind = found.cycles.front() % kSnapshotCycles;
    EXPECT_LT((kSnapshotCycles - behind) % kSnapshotCycles, 1000u) << "a chunk";
    EXPECT_GE(found.snapshots, kLaws);
  }
}

TEST_F(ABagLog, BeginsEachPartWithTheHeaderOfThatTime) {
  parameters.telemetry.split_time = 2;
  open();
  drive_on(1500);
  LogHeader later = log_header(parameters, loop.robot());
  later.parameters = "other: 1\n";
  log->set_header(later);
  drive_on(2500);
  log->close();
  ASSERT_THAT(names(), ElementsAre("run.1.bag", "run.bag"));
  EXPECT_EQ(TraceReader(path("run.1.bag")).header().parameters, log_header(parameters, loop.robot()).parameters);
  EXPECT_EQ(TraceReader(path()).header().parameters, later.parameters);
  EXPECT_EQ(TraceReader(path()).header().part, 1u);
}

TEST_F(ABagLog, IsSplitWithoutSnapshotsWhereNoneCome) {
  parameters.telemetry.split_time = 2;
  open();
  drive(loop, 16'000, [&](const JoinedRow& row) { log->write(row); });
  log->close();
  EXPECT_THAT(names(), ElementsAre("run.1.bag", "run.bag"));
}

TEST_F(ABagLog, KeepsTheNewestOfItsQuota) {
  parameters.telemetry.quota = 0.004;
  open();
  drive_on(20'000);
  log->close();
  EXPECT_EQ(log->unwritten(), 0u);
  std::uintmax_t bytes = 0;
  for (const std::string& name : names()) bytes += std::filesystem::file_size(path(name));
  EXPECT_LE(bytes, 4'000'000u);
  EXPECT_GE(bytes, 2'000'000u);
  const Found found = rows_of(path());
  EXPECT_EQ(found.cycles.back(), 19'999u);
  EXPECT_THAT(logs->take_removed(), testing::Contains(path("run.1.bag")));
}

TEST_F(ABagLog, SaysThatItsFileWasRemovedCountsAndBeginsAnother) {
  open();
  drive_on(1500);
  std::filesystem::remove_all(folder.path() / "log");
  EXPECT_THAT([&] { drive_on(1000); }, ThrowsMessage<LogError>(HasSubstr("was removed while it was written")));
  EXPECT_TRUE(log->broken());
  drive_on(1500);
  log->poll(1);
  EXPECT_TRUE(log->broken());
  log->poll(BagLog::kRetryNs + 2);
  EXPECT_FALSE(log->broken());
  drive_on(2000);
  log->close();
  const Found found = rows_of(path());
  EXPECT_FALSE(found.cycles.empty());
  EXPECT_EQ(found.lost.back(), log->unwritten()) << "the rows that follow name the loss";
  EXPECT_EQ(log->rows() + log->unwritten(), loop.cycle());
  EXPECT_GE(log->unwritten(), 2000u);
}

TEST_F(ABagLog, IsRemovedAtTheEndWithoutAMessageAndNotKeptAfterACrash) {
  parameters.telemetry.record = RecordMode::kRequest;
  open();
  std::filesystem::copy_file(path(), path("killed"));  // as after SIGKILL: it is not closed
  log.reset();
  std::filesystem::rename(path("killed"), path());
  open();
  drive_on(1500);
  EXPECT_THAT(names(), ElementsAre("run.bag"));
  log->close();
  EXPECT_THAT(names(), ElementsAre());
}

TEST_F(ABagLog, IsNotBegunWhereNothingCanBeWritten) {
  folder.write("log", "a file");
  EXPECT_THAT([&] { open(); }, ThrowsMessage<LogError>(HasSubstr("telemetry.directory")));
}

TEST_F(ABagLog, NamesTheRowsThatWereLostBeforeIt) {
  open();
  drive_on(100);
  log->set_lost(17);
  drive_on(100);
  log->close();
  const Found found = rows_of(path());
  EXPECT_EQ(found.lost[99], 0u);
  EXPECT_EQ(found.lost[100], 17u);
}

}  // namespace robot_control::tests
