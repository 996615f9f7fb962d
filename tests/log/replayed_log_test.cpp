/// A log holds everything that a replay needs: the results of the laws are computed again from the file, bit by bit.

#include <gtest/gtest.h>

#include "log/bag_log.h"
#include "log/replay/replay.h"
#include "log/trace_reader.h"
#include "loop/log_header.h"
#include "recorded_drive.h"
#include "support/recorded_loop.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct AReplayedLog : testing::Test {
  AReplayedLog() {
    TelemetryParameters all;
    all.record = RecordMode::kAlways;
    log = std::make_unique<BagLog>(logs, log_header(parameters, loop.robot()), all);
  }

  void drive_on(std::uint64_t cycles) {
    drive(loop, cycles, [&](const JoinedRow& row) {
      for (const LawSnapshot* snapshot : loop.snapshots()) {
        if (snapshot != nullptr) log->write(*snapshot);
      }
      log->write(row);
    });
  }

  void expect_replayed_whole() {
    log->close();
    Replay replay(loop.robot(), parameters.loop.period());
    TraceReader reader(folder.path() / "run.bag");
    EXPECT_TRUE(intact(reader.header()));
    reader.read({.message =
                     [&](const TraceRow& row, const BagMessage& message) {
                       replay.add(row, message.data, static_cast<std::int64_t>(message.time_ns));
                     },
                 .snapshot = [&](const LawSnapshot& snapshot, std::int64_t) { replay.add(snapshot); }});
    EXPECT_EQ(replay.report().rows, log->rows());
    EXPECT_EQ(replay.report().different_rows, 0u);
    for (const LawReport& law : replay.report().laws) {
      EXPECT_EQ(law.different, 0u);
      EXPECT_EQ(law.not_compared, 0u);
      EXPECT_GE(law.compared, log->rows() - 1) << "the gate has its first snapshot in cycle 0, or 1";
    }
    for (const ReplayDifference& difference : replay.report().differences) ADD_FAILURE() << sentence(difference);
  }

  Parameters parameters = drive_parameters();
  RecordedLoop loop{parameters};
  TemporaryFolder folder;
  LogFolder logs{folder.path(), 0};
  std::unique_ptr<BagLog> log;
};

TEST_F(AReplayedLog, IsExactOverStopsResetsTuningAndANewRun) {
  drive_on(1000);
  loop.e_stop();
  drive_on(800);
  loop.command({});
  loop.e_stop_reset();
  drive_on(700);
  loop.set_parameters("{max_linear_speed: 0.2, pid_kp: 1.1}");
  drive_on(700);
  loop.reset();
  drive_on(900);
  expect_replayed_whole();
}

}  // namespace robot_control::tests
