#pragma once
/// The three nodes that are woken by a frame: state_estimator, diff_drive_controller, safety_monitor.

#include <string>
#include <vector>

#include "runtime/controller_cycle.h"
#include "runtime/estimator_cycle.h"
#include "runtime/monitor_cycle.h"
#include "runtime/process.h"
#include "runtime/trace_sink.h"

namespace robot_control {

class EstimatorProcess final : public Process {
 public:
  EstimatorProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus);
  ~EstimatorProcess() override { stop(); }

  std::vector<std::string> missing() const override;
  EstimatorCycle& cycle() noexcept { return cycle_; }
  const FrameReader<SensorFrame>& sensors() const noexcept { return sensors_.reader; }
  const FrameReader<StateFrame>& state() const noexcept { return state_.reader; }

 private:
  void poll_channels() override;
  bool ready() override;
  void loop() noexcept override;

  RobotModel robot_;
  bool robot_agrees_ = false;
  Output<StateFrame> state_;
  Input<SensorFrame> sensors_;
  TraceSink<EstimatorTrace> trace_;
  EstimatorCycle cycle_;
};

class ControllerProcess final : public Process {
 public:
  ControllerProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus);
  ~ControllerProcess() override { stop(); }

  std::vector<std::string> missing() const override;
  ControllerCycle& cycle() noexcept { return cycle_; }
  const FrameReader<SensorFrame>& sensors() const noexcept { return sensors_.reader; }
  const FrameReader<CommandFrame>& command() const noexcept { return command_.reader; }

 private:
  void poll_channels() override;
  bool ready() override;
  void loop() noexcept override;

  RobotModel robot_;
  bool robot_agrees_ = false;
  Output<CommandFrame> command_;
  Input<SensorFrame> sensors_;
  Input<StateFrame> state_;
  Input<Permit> permit_;
  TraceSink<ControllerTrace> trace_;
  ControllerCycle cycle_;
};

class MonitorProcess final : public Process {
 public:
  MonitorProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus);
  ~MonitorProcess() override { stop(); }

  std::vector<std::string> missing() const override;
  MonitorCycle& cycle() noexcept { return cycle_; }
  const FrameReader<SensorFrame>& sensors() const noexcept { return sensors_.reader; }
  const FrameReader<Permit>& permit() const noexcept { return permit_.reader; }

 private:
  void poll_channels() override;
  bool ready() override;
  void loop() noexcept override;

  RobotModel robot_;
  bool robot_agrees_ = false;
  Output<Permit> permit_;
  Input<SensorFrame> sensors_;
  Input<StateFrame> state_;
  Input<CommandFrame> command_;
  TraceSink<MonitorTrace> trace_;
  MonitorCycle cycle_;
};

}  // namespace robot_control
