#pragma once
/// safety_monitor without ROS: woken by sensors, writes permit.

#include <string>
#include <vector>

#include "runtime/consumer_process.h"
#include "runtime/monitor_cycle.h"

namespace robot_control {

class MonitorProcess final : public ConsumerProcess<Permit, MonitorTrace> {
 public:
  /// Throws BusError; ParameterError for a script that cannot be read.
  MonitorProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus);
  ~MonitorProcess() override { stop(); }

  std::vector<std::string> missing() const override;
  MonitorCycle& cycle() noexcept { return cycle_; }

 private:
  void poll_channels() override;
  bool ready() override;
  void loop() noexcept override;

  Input<StateFrame> state_;
  Input<CommandFrame> command_;
  MonitorCycle cycle_;
};

}  // namespace robot_control
