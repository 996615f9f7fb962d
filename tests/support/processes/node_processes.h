#pragma once
/// The nodes of the loop run as processes of their own, the plant too, without ROS. Each may be stopped, killed and
/// started again by the test, which has a single thread.

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>

#include "drivers/mujoco/mujoco_plant.h"
#include "loop/processes/controller_process.h"
#include "loop/processes/driver_process.h"
#include "loop/processes/estimator_process.h"
#include "loop/processes/monitor_process.h"
#include "loop/processes/telemetry_process.h"
#include "robots/differential_drive.h"
#include "rt/crash_report.h"
#include "rt/futex.h"
#include "rt/realtime_thread.h"
#include "support/bus/scoped_bus.h"
#include "support/processes/anonymous_memory.h"
#include "support/processes/child_process.h"
#include "support/processes/shared_controls.h"
#include "support/temporary_folder.h"

namespace robot_control {

class NodeProcesses {
 public:
  explicit NodeProcesses(const Parameters& parameters)
      : NodeProcesses(parameters,
                      std::make_shared<DifferentialDrive>(
                          parameters, read_drive_train(load_description(parameters.urdf), parameters.robot))) {}

  /// A robot of any kind, composed with these parameters.
  NodeProcesses(const Parameters& parameters, std::shared_ptr<const Robot> robot)
      : parameters_(parameters), robot_(std::move(robot)) {
    new (controls_.get()) SharedControls();
    parameters_.telemetry.black_box = 0;     // see give_black_box
    parameters_.loop.wait_for_nodes = true;  // a run begins with all nodes there
  }

  void start_loop() {
    for (const LoopNode node : kLoop) start(node);
  }

  /// Forks the node. It receives no earlier message; its own outputs continue.
  void start(LoopNode node) {
    if (node == LoopNode::kController) controls_->command.store({});
    if (node == LoopNode::kMonitor) controls_->operator_input.store({});
    if (node == LoopNode::kTelemetry) controls_->lost_rows.store(0);
    controls_->missing[index_of(node)].store(0);
    processes_[index_of(node)] = std::make_unique<ChildProcess>([this, node] { return run(node); });
    // Only cycle 0 of the first run waits for all nodes; a restarted plant finds the others braking.
    if (node == LoopNode::kPlant) parameters_.loop.wait_for_nodes = false;
  }

  /// Ends the node and waits for that.
  void end(LoopNode node) {
    if (processes_[index_of(node)] != nullptr) processes_[index_of(node)]->kill();
  }

  ChildProcess& process(LoopNode node) { return *processes_[index_of(node)]; }
  bool lives(LoopNode node) {
    const auto& process = processes_[index_of(node)];
    return process != nullptr && process->lives();
  }
  bool misses(LoopNode node, LoopNode whom) const {
    return (controls_->missing[index_of(node)].load() >> index_of(whom) & 1U) != 0;
  }

  /// The node's output on stderr.
  std::string said(LoopNode node) const {
    std::ifstream file(log_of(node));
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Sets an action of the process before it becomes a node.
  void prepare(LoopNode node, std::function<void()> act) { preparations_[index_of(node)] = std::move(act); }

  SharedControls& controls() const noexcept { return *controls_.get(); }
  const std::string& bus() const noexcept { return bus_.name(); }
  const Parameters& parameters() const noexcept { return parameters_; }
  const DriveTrain& robot() const { return drive_train_of(robot_->machine()); }
  const Robot& composed() const noexcept { return *robot_; }
  const std::filesystem::path& folder() const { return folder_.path(); }

  /// Telemetry writes there from its next start on.
  void log_into(const std::string& directory) { parameters_.telemetry.directory = directory; }

  /// Telemetry keeps a black box of so many GB from its next start on.
  void give_black_box(double gigabytes) { parameters_.telemetry.black_box = gigabytes; }

 private:
  static constexpr std::int64_t kLookNs =
      5'000'000;  // twenty times as often as a ROS node polls, so that a test does not wait

  std::string log_of(LoopNode node) const { return folder_.path() / (std::string(name_of(node)) + ".log"); }

  int run(LoopNode node) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != test_) return 1;  // it was gone before
    const int log = open(log_of(node).c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    dup2(log, STDERR_FILENO);
    install_crash_report(name_of(node),
                         node == LoopNode::kTelemetry ? "the log with it" : "the motors brake without it");
    try {
      if (preparations_[index_of(node)]) preparations_[index_of(node)]();
      prepare_process(parameters_.loop.realtime);
      run_prepared(node);
      return 0;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: refused:\n%s\n", name_of(node), error.what());
      return 1;
    }
  }

  void run_prepared(LoopNode node) {
    switch (node) {
      case LoopNode::kPlant:
        return run_plant();
      case LoopNode::kEstimator:
        return run_consumer<EstimatorProcess>(node, [](EstimatorProcess&) {});
      case LoopNode::kController:
        return run_consumer<ControllerProcess>(node, [this](ControllerProcess& controller) {
          VelocityCommand command;
          if (controls_->command.load(command)) controller.cycle().inbox().store(command);
        });
      case LoopNode::kMonitor:
        return run_consumer<MonitorProcess>(node, [this](MonitorProcess& monitor) {
          OperatorInput input;
          if (controls_->operator_input.load(input)) monitor.cycle().inbox().store(input);
        });
      case LoopNode::kTelemetry:
        return run_telemetry();
    }
  }

  template <class Node, class Receive>
  [[noreturn]] void run_consumer(LoopNode name, Receive receive) {
    Node node(parameters_, *robot_, bus_.name());
    for (;;) {
      receive(node);
      node.poll();
      controls_->missing[index_of(name)].store(missing_bits(node.missing()));
      sleep_ns(kLookNs);
    }
  }

  [[noreturn]] void run_plant() {
    DriverProcess driver(parameters_, *robot_, bus_.name());
    const double period = parameters_.loop.period();
    auto plant = std::make_unique<MujocoPlant>(robot_->machine(), parameters_.plant, period);
    driver.open_driver(std::make_unique<SpoiledJoint>(std::move(plant), controls_->spoil, std::llround(1e9 * period)));
    for (;;) {
      driver.poll();
      controls_->missing[index_of(LoopNode::kPlant)].store(missing_bits(driver.missing()));
      sleep_ns(kLookNs);
    }
  }

  [[noreturn]] void run_telemetry() {
    TelemetryProcess telemetry(parameters_, *robot_, bus_.name());
    for (;;) {
      telemetry.poll();
      telemetry.drain();
      const TelemetryCounts counts = telemetry.counts();
      controls_->lost_rows.store(counts.dropped + counts.overwritten);
      if (!telemetry.problem().empty() && controls_->unwritten_rows.load() == 0) {
        std::fprintf(stderr, "%s\n", telemetry.problem().c_str());
      }
      if (!telemetry.problem().empty()) controls_->unwritten_rows.store(counts.bag_unwritten);
      sleep_ns(kLookNs);
    }
  }

  pid_t test_ = getpid();
  ScopedBus bus_;
  TemporaryFolder folder_;
  AnonymousMemory<SharedControls> controls_;
  Parameters parameters_;
  std::shared_ptr<const Robot> robot_;
  std::array<std::function<void()>, kLoopNodeNames.size()> preparations_;
  std::array<std::unique_ptr<ChildProcess>, kLoopNodeNames.size()> processes_;
};

}  // namespace robot_control
