/// A node is stopped, killed, or crashes at full speed.

#include <filesystem>

#include "log/trace_reader.h"
#include "losses_fixture.h"

namespace robot_control::tests {

struct Row {
  LoopNode node;
  int signal;
  std::uint64_t cause;  ///< latched, at the latest once the node is back
};

class ALostNode : public Losses, public ::testing::WithParamInterface<Row> {};

TEST_P(ALostNode, StopsTheRobotUntilResetAndANewCommand) {
  const auto [node, signal, cause] = GetParam();
  const MeasuredStop stop = robot_.lose(node, signal);
  std::printf("  %s of %s: brake after %llu cycles (%s), %.3f m to standstill\n", name_of_signal(signal).c_str(),
              name_of(node), static_cast<unsigned long long>(stop.cycles),
              names_of(kGateReasonNames, stop.reasons).c_str(), stop.distance);
  if (stop.measured()) {
    EXPECT_LE(stop.cycles, kBrakeWithin);
  }
  EXPECT_LT(stop.distance, 0.5) << "v²/2a with brakes of 2 · 2.2 N·m on wheels of 0.1 m under 12 kg: 0.14 m";
  if (signal != SIGSTOP) {
    EXPECT_FALSE(nodes().lives(node));
    EXPECT_EQ(nodes().process(node).ending_signal(), signal) << "and it hangs nowhere on its way";
    if (signal == SIGSEGV) expect_crash_report(node, SIGSEGV, "SIGSEGV");
    if (node != LoopNode::kMonitor) {
      EXPECT_TRUE(robot_.await([&] { return nodes().misses(LoopNode::kMonitor, node); })) << "the monitor names it";
    }
  }
  for (const LoopNode other : kLoop) {
    if (other != node) expect_lives(other);
  }
  robot_.bring_back(node, signal);
  expect_latched_until_reset_and_new_command(cause);
}

std::string name_of_row(const ::testing::TestParamInfo<Row>& each) {
  return std::string(name_of(each.param.node)) + "_" + name_of_signal(each.param.signal);
}

INSTANTIATE_TEST_SUITE_P(Each, ALostNode,
                         ::testing::Values(Row{LoopNode::kController, SIGSTOP, kCauseControllerLost},
                                           Row{LoopNode::kController, SIGSEGV, kCauseControllerLost},
                                           Row{LoopNode::kEstimator, SIGKILL, kCauseEstimatorLost},
                                           Row{LoopNode::kMonitor, SIGSTOP, kCauseMonitorLate},
                                           Row{LoopNode::kMonitor, SIGKILL, kCauseMonitorRestarted}),
                         name_of_row);
INSTANTIATE_TEST_SUITE_P(Nightly, ALostNode,
                         ::testing::Values(Row{LoopNode::kController, SIGKILL, kCauseControllerLost},
                                           Row{LoopNode::kEstimator, SIGSTOP, kCauseEstimatorLost},
                                           Row{LoopNode::kEstimator, SIGSEGV, kCauseEstimatorLost},
                                           Row{LoopNode::kMonitor, SIGSEGV, kCauseMonitorRestarted}),
                         name_of_row);

/// The plant is the world, too: its time ends, or stands still, with it.
class ALostPlant : public Losses, public ::testing::WithParamInterface<int> {};

TEST_P(ALostPlant, IsNamedByEveryOtherAndHoldsTheLatch) {
  nodes().process(LoopNode::kPlant).send(GetParam());
  EXPECT_TRUE(robot_.await([&] { return (robot_.permit().causes & kCauseDriverLost) != 0; })) << robot_.situation();
  if (GetParam() == SIGSTOP) {
    const std::uint64_t stood = robot_.cycle();
    nodes().process(LoopNode::kPlant).send(SIGCONT);
    EXPECT_TRUE(robot_.await([&] { return log().rested(DrivingRobot::kRestCycles); })) << robot_.situation();
    EXPECT_LE(*log().braking_since(), stood + 2) << "the first cycles find the latched permit";
  } else {
    EXPECT_TRUE(robot_.await([&] { return !nodes().lives(LoopNode::kPlant); }));
    EXPECT_EQ(nodes().process(LoopNode::kPlant).ending_signal(), GetParam());
    for (const LoopNode other : {LoopNode::kEstimator, LoopNode::kController, LoopNode::kMonitor}) {
      EXPECT_TRUE(robot_.await([&] { return nodes().misses(other, LoopNode::kPlant); })) << name_of(other);
    }
    EXPECT_NE(robot_.ask_reset() & kRefusalSilent, 0u) << robot_.situation();
    log().forget();
    robot_.restart(LoopNode::kPlant);
    EXPECT_TRUE(robot_.await([&] { return log().rested(DrivingRobot::kRestCycles); })) << robot_.situation();
  }
  for (const LoopNode other : kLoop) expect_lives(other);
  expect_latched_until_reset_and_new_command(kCauseDriverLost);
}

INSTANTIATE_TEST_SUITE_P(Each, ALostPlant, ::testing::Values(SIGSTOP, SIGKILL, SIGSEGV),
                         [](const auto& each) { return name_of_signal(each.param); });

/// The plant was absent for some milliseconds, or its absence could not be detected: time proves nothing.
struct APlantStartedAgain : Losses {
  void start_again() {
    nodes().end(LoopNode::kPlant);
    log().forget();
    robot_.restart(LoopNode::kPlant);
  }

  void expect_lost() {
    EXPECT_TRUE(robot_.await([&] { return log().rested(DrivingRobot::kRestCycles); })) << robot_.situation();
    expect_latched_until_reset_and_new_command(kCauseDriverLost);
  }
};

TEST_F(APlantStartedAgain, IsLost) {
  start_again();
  expect_lost();
}

TEST_F(APlantStartedAgain, IsLostWithAnotherObjectOfItsSensors) {
  std::filesystem::remove("/dev/shm" + bus_object_name(nodes().bus(), ChannelNames::kSensors));
  start_again();
  expect_lost();
}

TEST_F(APlantStartedAgain, IsLostBesideAMonitorThatSleptMeanwhile) {
  nodes().process(LoopNode::kMonitor).send(SIGSTOP);
  const std::uint64_t before = robot_.sensors().head.run;
  start_again();
  EXPECT_TRUE(robot_.await([&] { return robot_.sensors().head.run != before && robot_.cycle() > 20; }));
  nodes().process(LoopNode::kMonitor).send(SIGCONT);
  expect_lost();
}

/// The reader of the rows, which writes the log.
class ALostTelemetry : public Losses, public ::testing::WithParamInterface<int> {};

TEST_P(ALostTelemetry, HarmsNothing) {
  nodes().log_into(nodes().folder() / "log");
  nodes().start(LoopNode::kTelemetry);
  expect_drives_on(200);
  nodes().process(LoopNode::kTelemetry).send(GetParam());
  expect_drives_on(kRingRows + 500);  // its rings are full by then, if a node waited for room
  if (GetParam() == SIGSTOP) {
    nodes().process(LoopNode::kTelemetry).send(SIGCONT);
    EXPECT_TRUE(robot_.await([&] { return nodes().controls().lost_rows.load() > 0; })) << "what was lost is counted";
    expect_drives_on(200);
  }
  for (const LoopNode node : kLoop) expect_lives(node);
}

using NightlyLostTelemetry = Losses;

TEST_F(NightlyLostTelemetry, StoppedForTenSecondsCountsAndNamesWhatItMissed) {
  const std::filesystem::path log = nodes().folder() / "log";
  nodes().log_into(log);
  nodes().start(LoopNode::kTelemetry);
  expect_drives_on(1500);
  nodes().process(LoopNode::kTelemetry).send(SIGSTOP);
  expect_drives_on(10'000);
  nodes().process(LoopNode::kTelemetry).send(SIGCONT);
  EXPECT_TRUE(robot_.await([&] { return nodes().controls().lost_rows.load() > 0; })) << "counted";
  expect_drives_on(4000);

  std::uint64_t last = 0, missing = 0, lost = 0;
  TraceReader(log / "run.bag").read({.row = [&](const TraceRow& row, std::int64_t) {
    if (last != 0 && row.cycle > last + 1) missing += row.cycle - last - 1;
    last = row.cycle;
    lost = row.lost;
  }});
  EXPECT_GT(missing, 10'000 - kRingRows - 500) << "the rings hold some";
  EXPECT_GE(lost, 4 * missing) << "named: the row of each of the four nodes";
}

INSTANTIATE_TEST_SUITE_P(Each, ALostTelemetry, ::testing::Values(SIGSTOP),
                         [](const auto& each) { return name_of_signal(each.param); });
INSTANTIATE_TEST_SUITE_P(Nightly, ALostTelemetry, ::testing::Values(SIGKILL, SIGSEGV),
                         [](const auto& each) { return name_of_signal(each.param); });

}  // namespace robot_control::tests
