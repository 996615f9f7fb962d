#pragma once
/// Four cycles on channels in private memory, around a machine that only stores the reports it receives.

#include <memory>

#include "control/wheeled/drive_controller.h"
#include "drivers/driver.h"
#include "estimation/wheeled/estimator.h"
#include "loop/cycles/controller_cycle.h"
#include "loop/cycles/driver_cycle.h"
#include "loop/cycles/estimator_cycle.h"
#include "loop/cycles/monitor_cycle.h"
#include "robots/differential_drive.h"
#include "safety/conditions/wheeled/wheeled_conditions.h"
#include "simulation/faults/node_faults.h"

namespace robot_control {

inline constexpr double kPeriod = 0.001;
inline constexpr std::int64_t kPeriodNs = 1'000'000;
inline constexpr std::int64_t kLossNs = 20 * kPeriodNs;
inline constexpr Twist kAhead{.linear = {0.5, 0, 0}, .angular = {0, 0, 0}};

inline DriveTrain two_wheels() {
  DriveTrain robot;
  robot.name = "two_wheels";
  robot.source = "test";
  robot.hash = 7;
  robot.joints = {{"left_wheel_joint", "left_wheel_link", 3.0, 20.0},
                  {"right_wheel_joint", "right_wheel_link", 3.0, 20.0}};
  robot.wheels = {{.joint = 0, .centre_base = {0, 0.25, 0}, .radius = 0.1, .width = 0.04, .inertia = 0.005},
                  {.joint = 1, .centre_base = {0, -0.25, 0}, .radius = 0.1, .width = 0.04, .inertia = 0.005}};
  robot.wheels[1].side = Side::kRight;
  robot.wheel_base = 0.5;
  robot.mass = 12;
  robot.yaw_inertia = 0.4;
  robot.base_link = "base_link";
  return robot;
}

/// A machine that stands still for any report.
struct StandingMachine final : Simulator {
  void start() override {}
  void read(SensorFrame& sensors) noexcept override {
    sensors.injected = faults;
    sensors.driver_state = state;
    for (std::size_t i = 0; i < 2; ++i) sensors.joints[i].valid = measured;
    sensors.valid = kValidGyro | kValidAccelerometer;
    sensors.joint_count = 2;
    sensors.imu.linear_acceleration = {0, 0, 9.81};
  }
  void write(std::span<const JointCommand> commands) noexcept override { mode = commands[0].mode; }
  void stop() noexcept override {}
  void reset() noexcept override { ++resets; }
  void truth(TruthFrame&) noexcept override {}
  void inject(const InjectedFaults& wanted) noexcept override { faults = wanted; }

  InjectedFaults faults{};
  DriverState state = DriverState::kRunning;
  JointMode mode = JointMode::kBrake;
  std::uint32_t measured = kValidMotion;
  int resets = 0;
};

template <class Frame>
struct TestChannel {
  std::unique_ptr<LatestFrames<Frame>> memory = std::make_unique<LatestFrames<Frame>>();
  FrameWriter<Frame> writer{memory.get()};
  FrameReader<Frame> reader{memory.get()};

  Frame newest() const {
    Frame frame;
    reader.newest(frame);
    return frame;
  }
};

/// The channels of a robot.
struct TestChannels {
  DriverCycle::Channels of_driver() const { return {sensors.writer, truth.writer, &command.reader, &permit.reader}; }
  ControllerCycle::Channels of_controller() const {
    return {&sensors.reader, &state.reader, &permit.reader, command.writer};
  }
  MonitorCycle::Channels of_monitor() const { return {&sensors.reader, &state.reader, &command.reader, permit.writer}; }

  TestChannel<SensorFrame> sensors;
  TestChannel<TruthFrame> truth;
  TestChannel<StateFrame> state;
  TestChannel<CommandFrame> command;
  TestChannel<Permit> permit;
};

/// Each run begins with a zero request, which releases it at once.
inline CommandScript script_with_zero() {
  CommandScript script;
  script.begin_with_zero();
  return script;
}

struct Loop : TestChannels {
  Loop() {
    driver.set_driver_instance(99);
    driver.begin_run(1);
    restart_estimator();
    restart_controller();
    restart_monitor();
  }

  /// A killed and restarted node is a new object on the channels that its predecessor left.
  void restart_estimator() {
    estimator = std::make_unique<EstimatorCycle>(
        std::make_unique<EstimatorOf<Estimator>>(EstimatorParameters{}, robot, kPeriod), robot.hash, sensors.reader,
        state.writer, nullptr);
  }
  void restart_controller() {
    controller = std::make_unique<ControllerCycle>(
        std::make_unique<ControllerOf<DriveController>>(DriveControllerParameters{}, robot, kPeriod), robot.hash,
        of_controller(), script_with_zero(), nullptr);
  }
  void restart_monitor() {
    monitor =
        std::make_unique<MonitorCycle>(std::make_unique<MonitorOf<SafetyMonitor>>(SafetyParameters{}, robot, kPeriod),
                                       robot.hash, kLossNs, of_monitor(), CommandScript(), nullptr);
  }

  /// Runs one cycle of a node, and applies an injected fault to its output, as ClosedLoop does; null: it has no row.
  const EstimatorTrace* step_estimator() {
    return estimator->step() ? estimator_faults.replace(driver.trace().sensors, estimator->trace()) : nullptr;
  }
  const ControllerTrace* step_controller() {
    return controller->step() ? controller_faults.replace(driver.trace().sensors, controller->trace()) : nullptr;
  }
  const MonitorTrace* step_monitor() {
    return monitor->step() ? monitor_faults.replace(driver.trace().sensors, monitor->trace()) : nullptr;
  }

  /// Runs one cycle of all four.
  void step() {
    driver.step();
    step_estimator();
    step_controller();
    step_monitor();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  /// Begins to drive with a standing command; one from before the run would be dropped.
  void drive() {
    step();
    controller->inbox().store({.content = {.twist = kAhead}, .count = 1});
    steps(20);
  }

  Permit newest_permit() const { return permit.newest(); }
  CommandFrame newest_command() const { return command.newest(); }
  StateFrame newest_state() const { return state.newest(); }
  const GateReport& gate() const { return driver.trace().gate; }

  DriveTrain robot = two_wheels();
  StandingMachine machine;
  DriverCycle driver{machine, robot, of_driver(), kPeriodNs, nullptr};
  std::unique_ptr<EstimatorCycle> estimator;
  std::unique_ptr<ControllerCycle> controller;
  std::unique_ptr<MonitorCycle> monitor;
  EstimatorFaults estimator_faults{FaultComponent::kEstimator, state.writer};
  ControllerFaults controller_faults{FaultComponent::kController, command.writer};
  MonitorFaults monitor_faults{FaultComponent::kMonitor, permit.writer};
};

}  // namespace robot_control
