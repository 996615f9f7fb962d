/// The simulated robot whose drives the program `driver` commands over the bus of the drive file (`address:
/// unix:FOLDER`) or over a serial line. It makes a link at the address of a serial line. It publishes ground_truth/odom
/// and has the service ~inject_fault: component is a joint or `bus`, and `board` or `encoder` of a board.

#include <robot_control/InjectFault.h>
#include <ros/ros.h>

#include <atomic>
#include <memory>
#include <mutex>

#include "robots/robot_kind.h"
#include "ros/messages/motion_messages.h"
#include "ros/messages/service_answer.h"
#include "ros/messages/time_map.h"
#include "ros/nodes/node.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/pacer.h"
#include "rt/clock.h"
#include "rt/periodic.h"
#include "rt/realtime_thread.h"
#include "simulation/machines/simulated_machine.h"

namespace robot_control {
namespace {

constexpr int kPriority = 84;  // above the loop, as its frames would be on a real bus

class DeviceSimulatorNode final : public Node {
 public:
  explicit DeviceSimulatorNode(const Setup& setup)
      : setup_(setup),
        simulator_(make_device_simulator(setup.parameters, *setup.machine,
                                         compose(setup.parameters, *setup.machine)->brakes())),
        pace_(setup.parameters.report.truth_rate) {}
  ~DeviceSimulatorNode() override { end(); }

  void connect(ros::NodeHandle& handle) override {
    truth_ = handle.advertise<nav_msgs::Odometry>("ground_truth/odom", 10);
    inject_fault_ = ros::NodeHandle("~").advertiseService("inject_fault", &DeviceSimulatorNode::inject_fault, this);
    thread_ = std::make_unique<RealtimeThread>(
        RealtimeParameters{.name = "devices", .policy = setup_.parameters.loop.realtime, .priority = kPriority},
        [this] { run(); });
  }
  void poll() override {}
  std::int64_t tick_ns() const override { return publish_tick_ns(setup_.parameters, monotonic_ns(), {&pace_}); }
  bool finished() const override { return false; }
  void stop() override { end(); }
  std::vector<std::string> missing() const override { return {}; }
  std::vector<std::string> realtime_messages() const override { return {}; }
  void diagnose(DiagnosticReport& report) override {
    report.value("slipped_s", 1.0e-9 * static_cast<double>(slipped_ns_.load()));
  }

  void publish() override {
    SensorFrame now;
    now.head.stamp_ns = monotonic_ns();
    time_.follow(now);
    if (!pace_.due(1, now.head.stamp_ns)) return;
    TruthFrame truth;
    if (!simulator_->truth(truth)) return;
    const ReportParameters& report = setup_.parameters.report;
    truth_.publish(ground_truth(truth, report.odom_frame, report.base_frame, time_.at(now.head.stamp_ns)));
  }

 private:
  void run() {
    Periodic schedule(monotonic_ns(), setup_.parameters.loop.period_ns(), WhenLate::kSlip);
    while (!ending_.load()) {
      sleep_until(schedule.deadline_ns());
      schedule.begin(monotonic_ns());
      {
        const std::lock_guard lock(mutex_);
        simulator_->step();
      }
      schedule.end(monotonic_ns());
      slipped_ns_.store(schedule.slipped_ns());
    }
  }

  void end() {
    ending_.store(true);
    if (thread_) thread_->join();
  }

  bool inject_fault(InjectFault::Request& request, InjectFault::Response& response) {
    const std::lock_guard lock(mutex_);
    const std::string problem = simulator_->inject(request.component, request.kind);
    return answer(response, problem.empty(), problem.empty() ? request.component + " " + request.kind : problem);
  }

  Setup setup_;
  std::mutex mutex_;  // of a step and of a fault
  std::unique_ptr<DeviceSimulator> simulator_;
  Pacer pace_;
  TimeMap time_{ClockMode::kWall};
  ros::Publisher truth_;
  ros::ServiceServer inject_fault_;
  std::atomic<bool> ending_{false};
  std::atomic<std::int64_t> slipped_ns_{0};
  std::unique_ptr<RealtimeThread> thread_;
};

}  // namespace
}  // namespace robot_control

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(
      argc, argv,
      {.name = "device_simulator",
       .purpose = "Simulates a robot with motor drives on CAN or a motor board. The program driver commands it "
                  "over the bus or line of the drive file.",
       .make = [](const Setup& setup) -> std::unique_ptr<Node> {
         return std::make_unique<DeviceSimulatorNode>(setup);
       }});
}
