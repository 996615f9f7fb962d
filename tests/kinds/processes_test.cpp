/// A second robot kind as four processes: in lockstep with its log and replay, and on the wall clock without its
/// controller.

#include <gtest/gtest.h>

#include <cmath>

#include "kinds/pendulum.h"
#include "log/replay/recorded.h"
#include "log/trace_reader.h"
#include "rt/clock.h"
#include "rt/futex.h"
#include "support/log_table.h"
#include "support/processes/four_nodes.h"
#include "support/processes/node_processes.h"
#include "support/recorded_loop.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

constexpr double kPatience = 60;           // s
constexpr std::uint64_t kStopWithin = 20;  // cycles
constexpr std::int64_t kLookNs = 5'000'000;

TEST(SecondKindProcesses, LockstepGivesTheNumbersOfTheClosedLoopAndALogThatIsReplayed) {
  const TemporaryFolder folder;
  const std::string script =
      folder.write("script.csv", "cycle,linear,angular,event\n1,0,1,\n300,0,1,\n600,0,1,\n900,,,e_stop\n").string();
  Parameters parameters = read_parameters(std::string(PROJECT_DIRECTORY) + "/config/robot_params.yaml",
                                          {{"robot.command_script", script, "test"}});
  parameters.robot = {};
  parameters.loop.clock = ClockMode::kLockstep;
  parameters.loop.wait_for_nodes = parameters.loop.wait_for_telemetry = true;
  parameters.plant.cycles = 1500;
  parameters.telemetry.record = RecordMode::kAlways;
  parameters.telemetry.directory = (folder.path() / "log").string();
  const auto robot = std::make_shared<Pendulum>(parameters);
  FourNodes(parameters, robot, true).run(kPatience);

  const std::string bag = folder.path() / "log" / "run.bag";
  RecordedLoop loop(parameters, robot);
  LogTable one(robot->machine(), parameters.loop.period());
  for (int k = 0; k < 1500; ++k) {
    loop.step();
    one.add(loop.row());
  }
  const LogTable four = LogTable::of_bag(bag);
  EXPECT_EQ(LogTable::difference(four, one), "");

  TraceReader log(bag);
  EXPECT_EQ(log.header().robot, "pendulum");
  EXPECT_EQ(log.header().kind, "pendulum");
  EXPECT_EQ(log.header().roles, std::vector<std::string>{"driven"});
  EXPECT_EQ(log.header().joints, std::vector<std::string>{"pole_joint"});
  Replay replay(*robot, parameters.loop.period());
  log.read({.snapshot = [&](const LawSnapshot& snapshot, std::int64_t) { replay.add(snapshot); }});
  log.read({.message = [&](const TraceRow& row, const BagMessage& message) {
    replay.add(row, message.data, static_cast<std::int64_t>(message.time_ns));
  }});
  EXPECT_TRUE(replay.report().exact()) << text_of(replay.report());
  for (const LawReport& law : replay.report().laws) EXPECT_GE(law.compared, 1500u) << text_of(replay.report());
}

/// Lifts the pole and watches the sensors of a robot of four processes.
class LiftedPole {
 public:
  explicit LiftedPole(const Parameters& parameters)
      : nodes_(parameters, std::make_shared<Pendulum>(parameters)), sensors_(nodes_.bus(), ChannelNames::kSensors) {
    nodes_.start_loop();
  }

  bool await(const std::function<bool()>& event) {
    const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(kPatience * 1e9);
    while (!event()) {
      if (monotonic_ns() > end_ns) return false;
      command_.content.twist.angular[2] = speed_;
      ++command_.count;
      nodes_.controls().command.store(command_);
      sensors_.poll();
      sensors_.reader.newest(newest_);
      sleep_ns(kLookNs);
    }
    return true;
  }
  void lift(double speed) { speed_ = speed; }
  const SensorFrame& sensors() const { return newest_; }
  NodeProcesses& nodes() { return nodes_; }

 private:
  NodeProcesses nodes_;
  Input<SensorFrame> sensors_;
  SensorFrame newest_;
  VelocityCommand command_;
  double speed_ = 0;  // rad/s
};

TEST(SecondKindProcesses, AControllerThatIsKilledIsFollowedByTheStopAction) {
  Parameters parameters = read_parameters(std::string(PROJECT_DIRECTORY) + "/config/robot_params.yaml");
  parameters.robot = {};
  LiftedPole pole(parameters);
  ASSERT_TRUE(pole.await([&] { return pole.sensors().head.cycle > 200; })) << pole.nodes().said(LoopNode::kPlant);
  pole.lift(1.0);
  ASSERT_TRUE(pole.await([&] { return pole.sensors().joints[0].position > 0.8; }))
      << pole.nodes().said(LoopNode::kController) << pole.nodes().said(LoopNode::kMonitor);
  pole.nodes().end(LoopNode::kController);
  ASSERT_TRUE(pole.await([&] { return pole.sensors().gate.verdict == GateVerdict::kBrake; }));
  EXPECT_LE(pole.sensors().gate.missed, kStopWithin + static_cast<std::uint64_t>(kLookNs / 1'000'000));
  const std::uint64_t braked = pole.sensors().head.cycle;
  ASSERT_TRUE(pole.await([&] { return pole.sensors().head.cycle > braked + 1500; }));
  EXPECT_LT(std::abs(pole.sensors().joints[0].position), 0.05);
}

}  // namespace robot_control::tests
