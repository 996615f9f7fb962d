#include "robots/differential_drive.h"

#include "control/wheeled/drive_controller.h"
#include "estimation/wheeled/estimator.h"
#include "gate/wheeled/wheel_stop.h"
#include "robots/wheeled/retuning.h"
#include "robots/wheeled/safety_limits.h"
#include "robots/wheeled/slow_loop.h"
#include "robots/wheeled/start_check.h"
#include "safety/conditions/wheeled/wheeled_conditions.h"

namespace robot_control {

DifferentialDrive::DifferentialDrive(const Parameters& parameters, const DriveTrain& machine)
    : parameters_(parameters), machine_(machine) {}

void DifferentialDrive::require_drivable() const {
  robot_control::require_drivable(parameters_, machine_);
}

std::uint64_t DifferentialDrive::executable() const noexcept {
  return DriveController::kExecutable;
}

std::unique_ptr<EstimatorLaw> DifferentialDrive::make_estimator() const {
  return std::make_unique<EstimatorOf<Estimator>>(parameters_.estimator, machine_, parameters_.loop.period());
}

std::unique_ptr<ControllerLaw> DifferentialDrive::make_controller() const {
  return std::make_unique<ControllerOf<DriveController>>(parameters_.controller, machine_, parameters_.loop.period());
}

std::unique_ptr<MonitorLaw> DifferentialDrive::make_monitor() const {
  return std::make_unique<MonitorOf<SafetyMonitor>>(safety_limits(parameters_, machine_), machine_,
                                                    parameters_.loop.period());
}

MachineNeeds DifferentialDrive::needs() const {
  if (machine_.wheel_command == WheelCommand::kVelocity)
    return {.modes = {JointMode::kBrake, JointMode::kDriveVelocity}, .inputs = {MachineInput::kJointMotion}};
  return {.modes = {JointMode::kBrake, JointMode::kEffort},
          .inputs = {MachineInput::kJointMotion, MachineInput::kJointEffort}};
}

std::vector<std::string> DifferentialDrive::rate_notes(Role role) const {
  std::vector<std::string> notes = wheeled_rate_notes(parameters_, machine_, role);
  if (role == Role::kMonitor && machine_.wheel_command == WheelCommand::kVelocity) {
    notes.emplace_back(
        "robot.wheel_command is velocity: if the drives measure no torque, wheel_effort, power and torque_oscillation "
        "detect nothing, and stall uses speeds only");
  }
  return notes;
}

std::vector<Brake> DifferentialDrive::brakes() const {
  return brakes_of_slow_drives(machine_, parameters_.loop.period());
}

GateParameters DifferentialDrive::gate() const {
  StopProfile stops(machine_.joints.size());
  for (std::size_t i = 0; i < machine_.wheels.size(); ++i) {
    stops[machine_.wheels[i].joint] = wheel_stop(machine_, i, parameters_.loop.fail_action);
  }
  return {.profiles = {stops}, .longest_ramp = longest_ramp(parameters_.safety, parameters_.loop.period())};
}

std::unique_ptr<Retuner> DifferentialDrive::make_retuner(LatestValue<LiveTuning>& inbox) const {
  return std::make_unique<Retuning>(parameters_, machine_, inbox);
}

}  // namespace robot_control
