#pragma once
/// The controller without ROS: woken by state, writes command.

#include <memory>
#include <string>
#include <vector>

#include "loop/cycles/controller_cycle.h"
#include "loop/processes/consumer_process.h"
#include "robots/robot.h"

namespace robot_control {

class ControllerProcess final : public ConsumerProcess<CommandFrame, ControllerTrace> {
 public:
  /// Throws BusError; ParameterError for a script that cannot be read, and as Robot::require_drivable.
  ControllerProcess(const Parameters& parameters, const Robot& robot, const std::string& bus);
  ~ControllerProcess() override { stop(); }

  std::vector<std::string> missing() const override;
  const FrameReader<Permit>& permits() const noexcept { return permit_.reader; }
  const FrameReader<StateFrame>& states() const noexcept { return state_.reader; }
  ControllerCycle& cycle() noexcept { return cycle_; }
  /// Null: nothing of this kind's controller changes while it runs.
  Retuner* retuner() noexcept { return retuner_.get(); }

 private:
  void poll_channels() override;
  bool ready() override;
  void loop() noexcept override {
    consume(cycle_, state_.reader, kStopCheck, [] { return false; });
  }

  Input<StateFrame> state_;
  Input<Permit> permit_;
  ControllerCycle cycle_;
  std::unique_ptr<Retuner> retuner_;
};

}  // namespace robot_control
