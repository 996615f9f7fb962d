#pragma once
/// The monitor without ROS: woken by sensors, writes permit.

#include <string>
#include <vector>

#include "loop/cycles/monitor_cycle.h"
#include "loop/latch_file.h"
#include "loop/processes/consumer_process.h"
#include "robots/robot.h"

namespace robot_control {

class MonitorProcess final : public ConsumerProcess<Permit, MonitorTrace> {
 public:
  /// Throws BusError; ParameterError for a script that cannot be read.
  MonitorProcess(const Parameters& parameters, const Robot& robot, const std::string& bus);
  ~MonitorProcess() override;

  std::vector<std::string> missing() const override;
  MonitorCycle& cycle() noexcept { return cycle_; }

  /// One line on the causes latched when this process started, since when, and how to release them; empty: none.
  const std::string& restored() const noexcept { return restored_; }

  /// When this process started, the topic `e_stop` counted as true.
  bool e_stop_restored() const noexcept { return (inherited_.active & kCauseEmergencyStopTopic) != 0; }

  /// Why latch_file does not hold what is latched; empty: it does, or there is none. Only for the thread that polls.
  const std::string& latch_file_problem() const noexcept { return latch_file_.problem(); }

 private:
  template <class Keep>
  void with_latched(Keep keep) const;
  void poll_channels() override;
  bool ready() override;
  void loop() noexcept override;

  Input<StateFrame> state_;
  Input<CommandFrame> command_;
  LatchFile latch_file_;
  std::int64_t loss_ns_;
  MonitorCycle cycle_;
  Permit inherited_;  ///< the latch when this process started
  std::string restored_;
};

}  // namespace robot_control
