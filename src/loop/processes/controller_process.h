#pragma once
/// The controller without ROS: woken by state, writes command.

#include <string>
#include <vector>

#include "loop/cycles/controller_cycle.h"
#include "loop/processes/consumer_process.h"
#include "loop/retuning.h"

namespace robot_control {

class ControllerProcess final : public ConsumerProcess<CommandFrame, ControllerTrace> {
 public:
  /// Throws BusError; ParameterError for a script that cannot be read, or limits and gains that control_problems.h
  /// refuses.
  ControllerProcess(const Parameters& parameters, const DriveTrain& robot, const std::string& bus);
  ~ControllerProcess() override { stop(); }

  std::vector<std::string> missing() const override;
  const FrameReader<Permit>& permits() const noexcept { return permit_.reader; }
  ControllerCycle& cycle() noexcept { return cycle_; }
  Retuning& retuning() noexcept { return retuning_; }

 private:
  void poll_channels() override;
  bool ready() override;
  void loop() noexcept override;

  Input<StateFrame> state_;
  Input<Permit> permit_;
  ControllerCycle cycle_;
  Retuning retuning_;
};

}  // namespace robot_control
