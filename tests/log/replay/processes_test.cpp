/// Four processes run on the wall clock: their results are computed again from their log, bit by bit.

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "log/replay/recorded.h"
#include "log/trace_reader.h"
#include "support/processes/driving_robot.h"

namespace robot_control::tests {

struct ReplayedProcesses : testing::Test {
  ReplayedProcesses() {
    robot_.nodes().log_into(folder_.string());
    robot_.nodes().start(LoopNode::kTelemetry);
  }

  /// Rows may be lost if this machine stands still; then they are named, and most are still compared.
  void expect_exact() {
    robot_.nodes().end(LoopNode::kTelemetry);
    TraceReader log((folder_ / "run.bag").string());
    Replay replay(robot_.nodes().composed(), robot_.nodes().parameters().loop.period());
    log.read({.snapshot = [&](const LawSnapshot& snapshot, std::int64_t) { replay.add(snapshot); }});
    log.read({.message = [&](const TraceRow& row, const BagMessage& message) {
      replay.add(row, message.data, static_cast<std::int64_t>(message.time_ns));
    }});
    const ReplayReport report = replay.report();
    EXPECT_TRUE(report.exact()) << text_of(report);
    for (const LawReport& law : report.laws) {
      EXPECT_GT(law.compared, 9 * law.not_compared) << text_of(report);
      EXPECT_GT(law.compared, 500u) << text_of(report);
    }
  }

  void lose(LoopNode node, int signal) {
    robot_.lose(node, signal);
    if (signal == SIGSTOP) {
      robot_.nodes().process(node).send(SIGCONT);
    } else {
      robot_.restart(node);
    }
    robot_.drive_at_full_speed();
  }

  DrivingRobot robot_{DrivingRobot::quick(PROJECT_DIRECTORY "/config/robot_params.yaml")};
  const std::filesystem::path folder_ = robot_.nodes().folder() / "log";
};

/// The log that telemetry writes, up to the chunk that was on the disk when telemetry was killed.
TEST_F(ReplayedProcesses, AreExactOnADriveInWhichEveryNodeIsLostAndStartedAgain) {
  robot_.drive_at_full_speed();
  lose(LoopNode::kController, SIGSTOP);
  lose(LoopNode::kEstimator, SIGKILL);
  lose(LoopNode::kMonitor, SIGKILL);
  lose(LoopNode::kController, SIGKILL);
  robot_.restart(LoopNode::kPlant);
  robot_.drive_at_full_speed();
  robot_.await_cycles(2000);  // more than a chunk
  expect_exact();
}

}  // namespace robot_control::tests
