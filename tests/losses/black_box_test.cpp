/// All nodes and telemetry are killed at full speed, at a random moment: the black box holds everything until then.

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "log/black_box/saved_black_box.h"
#include "log/trace_reader.h"
#include "losses_fixture.h"

namespace robot_control::tests {

struct ABlackBox : Losses {
  /// ns; ten milliseconds are promised if telemetry's thread precedes others. Otherwise up to 144 were measured.
  static constexpr std::int64_t kMaxMissing = 1'000'000'000;

  /// s; the black box is saved five seconds after a stop, by a thread of the lowest priority.
  static constexpr double kMaxSaving = 120;

  ABlackBox() {
    std::filesystem::create_directories(folder_);
    nodes().log_into(folder_);
    nodes().give_black_box(0.05);
    nodes().start(LoopNode::kTelemetry);
  }

  bool await_bag(const std::string& name) {
    return robot_.await([&] { return std::filesystem::exists(folder_ / "black_box" / name); }, kMaxSaving);
  }

  std::filesystem::path folder_ = nodes().folder() / "log";
  std::string ring_ = folder_ / "black_box" / "ring";
};

TEST_F(ABlackBox, HoldsEveryCycleUpToTheSigkillOfAllNodes) {
  std::mt19937 random(18);
  for (int trial = 0; trial < 3; ++trial) {
    robot_.await_cycles(500 + random() % 500);
    const std::int64_t killed_ns = monotonic_ns();
    nodes().end(LoopNode::kTelemetry);
    for (const LoopNode node : kLoop) nodes().process(node).stop_with(SIGKILL);
    const std::filesystem::path to = folder_ / ("trial" + std::to_string(trial));
    const SavedBlackBox saved = save_black_box(ring_, to / "run.bag");
    EXPECT_EQ(saved.missing, "");
    for (const std::int64_t newest_ns : saved.newest_ns) EXPECT_LT(killed_ns - newest_ns, kMaxMissing);
    EXPECT_GT(saved.rows, 100u);

    std::uint64_t last = 0, rows = 0, run = 0;
    TraceReader reader(to / "run.bag");
    reader.read({.row = [&](const TraceRow& row, std::int64_t) {
      if (row.repeats) return;
      ++rows;
      // A law that starts before the driver computes the newest frame of the previous run.
      const bool begins = std::exchange(run, row.run_id) != row.run_id;
      EXPECT_TRUE(begins || row.cycle == last + 1) << "trial " << trial << ", cycle " << row.cycle << " after " << last;
      last = row.cycle;
    }});
    EXPECT_EQ(rows, saved.rows);
    if (trial == 2) break;
    robot_.restart_all();
    robot_.restart(LoopNode::kTelemetry);
    robot_.drive_at_full_speed();
  }
  nodes().start(LoopNode::kTelemetry);
  for (const char* name : {"crash.1.bag", "crash.2.bag", "crash.3.bag"}) EXPECT_TRUE(await_bag(name)) << name;
}

using NightlyBlackBox = ABlackBox;

TEST_F(NightlyBlackBox, IsSavedWithFiveSecondsAfterALatchedStop) {
  robot_.await_cycles(500);
  nodes().process(LoopNode::kEstimator).stop_with(SIGSTOP);
  ASSERT_TRUE(await_bag("stop.1.bag"));
  std::uint64_t stop = 0, last = 0;
  TraceReader(folder_ / "black_box" / "stop.1.bag").read({.row = [&](const TraceRow& row, std::int64_t) {
    last = row.cycle;
    if (stop == 0 && row.monitor.permit.causes != 0) stop = row.cycle;
  }});
  EXPECT_GT(stop, 0u);
  EXPECT_GT(last, stop + 2500) << "of 5000; this machine may stall";
}

/// Telemetry came later than the nodes' first snapshots: the remaining rows hold the next ones.
TEST_F(ABlackBox, HoldsASnapshotOfEachLawBeforeAStopRightAfterTheStartOfTelemetry) {
  nodes().end(LoopNode::kTelemetry);
  std::filesystem::remove_all(folder_);
  robot_.await_cycles(3000);
  nodes().start(LoopNode::kTelemetry);
  std::error_code absent;
  const auto log_bytes = [&] {
    const auto bytes = std::filesystem::file_size(folder_ / "run.bag", absent);
    return absent ? 0 : bytes;
  };
  ASSERT_TRUE(robot_.await([&] { return log_bytes() > 100'000; })) << "it takes rows";
  nodes().process(LoopNode::kEstimator).stop_with(SIGSTOP);
  ASSERT_TRUE(await_bag("stop.1.bag"));
  std::uint64_t first = 0, stop = 0;
  std::vector<LawSnapshot> snapshots;
  TraceReader reader(folder_ / "black_box" / "stop.1.bag");
  reader.read({.row =
                   [&](const TraceRow& row, std::int64_t) {
                     if (first == 0) first = row.cycle;
                     if (stop == 0 && row.monitor.permit.causes != 0) stop = row.cycle;
                   },
               .snapshot = [&](const LawSnapshot& snapshot, std::int64_t) { snapshots.push_back(snapshot); }});
  for (std::size_t law = 0; law < kLaws; ++law) {
    EXPECT_TRUE(std::ranges::any_of(snapshots, [&](const LawSnapshot& snapshot) {
      const std::uint64_t cycle = snapshot.head.cycle;
      return static_cast<std::size_t>(snapshot.law) == law && first <= cycle && cycle < stop;
    })) << kLawNames.at(law);
  }
}

TEST_F(NightlyBlackBox, IsSavedAfterTheStopForALostDriverToo) {
  robot_.await_cycles(500);
  nodes().process(LoopNode::kPlant).stop_with(SIGKILL);
  EXPECT_TRUE(await_bag("stop.1.bag"));
}

TEST_F(ABlackBox, HarmsNothingWhereTheDiskHasNoRoomAndTelemetrySaysSo) {
  nodes().end(LoopNode::kTelemetry);
  nodes().prepare(LoopNode::kTelemetry, [] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1 << 20, 1 << 20};
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  nodes().start(LoopNode::kTelemetry);
  EXPECT_TRUE(robot_.await([&] { return !nodes().lives(LoopNode::kTelemetry); }));
  const std::string said = nodes().said(LoopNode::kTelemetry);
  EXPECT_NE(said.find("no room for the black box"), std::string::npos) << said;
  EXPECT_NE(said.find("telemetry.black_box"), std::string::npos) << said;
  EXPECT_FALSE(std::filesystem::exists(ring_)) << "nothing is left of it";
  expect_undisturbed();
}

}  // namespace robot_control::tests
