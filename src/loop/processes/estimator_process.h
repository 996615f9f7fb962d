#pragma once
/// The estimator without ROS: woken by sensors, writes state.

#include <string>

#include "loop/cycles/estimator_cycle.h"
#include "loop/processes/consumer_process.h"
#include "robots/robot.h"

namespace robot_control {

class EstimatorProcess final : public ConsumerProcess<StateFrame, EstimatorTrace> {
 public:
  EstimatorProcess(const Parameters& parameters, const Robot& robot, const std::string& bus);
  ~EstimatorProcess() override { stop(); }

  EstimatorCycle& cycle() noexcept { return cycle_; }

 private:
  void loop() noexcept override {
    consume(cycle_, sensors_.reader, kStopCheck, [] { return false; });
  }

  EstimatorCycle cycle_;
};

}  // namespace robot_control
