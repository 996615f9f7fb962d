#pragma once
/// The controller drives the rigid plant with the bus's order of events. The command of cycle k acts over [t_k+1,
/// t_k+2), and the sensors of k hold the gate's verdict of tick k−1. Everything is healthy until a test spoils it.

#include <cstdint>
#include <functional>
#include <optional>

#include "control/wheeled/drive_controller.h"
#include "control/wheeled/test_robot.h"
#include "control/wheeled/two_wheel_plant.h"

namespace robot_control {

/// Without a jerk limit and without a stronger emergency deceleration, ramps are straight lines of 1 m/s², 4 rad/s².
inline DriveControllerParameters straight_ramps() {
  DriveControllerParameters parameters;
  parameters.max_linear_jerk = parameters.max_angular_jerk = 0;
  parameters.max_linear_emergency_deceleration = parameters.max_linear_acceleration;
  parameters.max_angular_emergency_deceleration = parameters.max_angular_acceleration;
  return parameters;
}

class ControlBench {
 public:
  explicit ControlBench(const DriveTrain& model = make_test_robot(), const DriveControllerParameters& parameters = {},
                        double period_s = 1e-3, const std::optional<DriveTrain>& truth = {})
      : period(period_s), controller(parameters, model, period_s), plant(truth.value_or(model)), robot(model) {
    controller.enter_run();
    permit.action = PermitAction::kDrive;
    permit.speed_limit = kNoSpeedLimit;
    state.base.flags = kStateValid;
    set_joints_valid(sensors, kValidMotion);
    sensors.joint_count = model.joints.size();
  }

  double period;
  DriveController controller;
  TwoWheelPlant plant;
  DriveTrain robot;
  SensorFrame sensors;
  StateFrame state;
  Permit permit;
  bool with_state = true;
  bool with_permit = true;
  VelocityCommand request;
  CommandFrame command;     ///< of the last cycle
  std::uint64_t cycle = 0;  ///< the next one
  std::function<void(SensorFrame&)> spoil = [](SensorFrame&) {};

  void send(double linear, double angular) {
    request.content.twist = {.linear = {linear, 0, 0}, .angular = {0, 0, angular}};
    ++request.count;
  }

  /// Sensors k → command k; then tick k applies command k−1.
  void step() {
    sample();
    const CommandFrame last = command;
    const ControlInput input{&sensors, with_state ? &state : nullptr, with_permit ? &permit : nullptr, request};
    controller.step(input, command);
    const bool passed =
        cycle > 0 && with_permit && permit.action != PermitAction::kBrake && last.joints[0].mode == JointMode::kEffort;
    sensors.gate.verdict = passed ? GateVerdict::kPassed : GateVerdict::kBrake;
    if (passed) {
      plant.drive({last.joints[0].effort, last.joints[1].effort}, period);
    } else {
      plant.brake(period);
    }
    ++cycle;
  }

  void run(double seconds) {
    const auto cycles = static_cast<std::uint64_t>(seconds / period + 0.5);
    for (std::uint64_t i = 0; i < cycles; ++i) step();
  }

 private:
  void sample() {
    const SidePair angle = plant.measured_angle();
    sensors.head.cycle = state.head.cycle = permit.head.cycle = cycle;
    sensors.joints[0] = {
        .position = angle.left, .velocity = plant.speed.left, .effort = plant.effort.left, .valid = kValidMotion};
    sensors.joints[1] = {
        .position = angle.right, .velocity = plant.speed.right, .effort = plant.effort.right, .valid = kValidMotion};
    spoil(sensors);
  }
};

}  // namespace robot_control
