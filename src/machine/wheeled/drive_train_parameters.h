#pragma once

#include <optional>
#include <string>
#include <vector>

#include "machine/machine_parameters.h"
#include "parameters/block.h"

namespace robot_control {

/// The command that the drive wheels of a robot take.
enum class WheelCommand {
  kTorque,    ///< Our wheel loops compute torques (JointMode::kEffort).
  kVelocity,  ///< The drives close the loops of their speeds (JointMode::kDriveVelocity).
};

inline std::vector<Word> words_of(WheelCommand) {
  return {{"torque", WheelCommand::kTorque}, {"velocity", WheelCommand::kVelocity}};
}

/// Holds the `robot:` block: the user's values for the machine and for its drive wheels.
struct DriveTrainParameters : MachineParameters {
  std::vector<std::string> left_wheel_joints;           ///< both empty: the wheels are found (drive_wheels.h)
  std::vector<std::string> right_wheel_joints;          ///< as many as left ones
  std::optional<double> wheel_base;                     ///< m, between left and right wheel centres
  std::optional<double> wheel_base_multiplier;          ///< effective over geometric wheel base; see DriveTrain
  std::optional<double> wheel_radius;                   ///< m, every wheel
  std::optional<double> left_wheel_radius_multiplier;   ///< multiplies the left wheels' radius, given or the URDF's
  std::optional<double> right_wheel_radius_multiplier;  ///< multiplies the right wheels' radius
  std::optional<double> wheel_effort_limit;             ///< N·m, every wheel; also that of the simulated drive
  std::optional<double> wheel_velocity_limit;           ///< rad/s, every wheel
  std::optional<double> wheel_effort_rate;              ///< N·m/s, every wheel; empty: kEffortRise
  WheelCommand wheel_command = WheelCommand::kTorque;
  double wheel_response_time = 0.05;  ///< s, of drives that take velocities: from a step of the command to 63 % of it
};

inline Keys keys(DriveTrainParameters& robot) {
  return joined({
      {
          {"left_wheel_joints", &robot.left_wheel_joints, {}, 0, 0, kOptional},
          {"left_wheel_joint", &robot.left_wheel_joints, {}, 0, 0, kOptional, "left_wheel_joints"},
          {"right_wheel_joints", &robot.right_wheel_joints, {}, 0, 0, kOptional},
          {"right_wheel_joint", &robot.right_wheel_joints, {}, 0, 0, kOptional, "right_wheel_joints"},
          {"wheel_base", &robot.wheel_base, "m", 0.01, 10, kOptional},
          {"wheel_separation", &robot.wheel_base, "m", 0.01, 10, kOptional, "wheel_base"},
          {"wheel_base_multiplier", &robot.wheel_base_multiplier, {}, 0.2, 20, kOptional},
          {"wheel_separation_multiplier",
           &robot.wheel_base_multiplier,
           {},
           0.2,
           20,
           kOptional,
           "wheel_base_multiplier"},
          {"wheel_radius", &robot.wheel_radius, "m", 0.005, 2, kOptional},
          {"left_wheel_radius_multiplier", &robot.left_wheel_radius_multiplier, {}, 0.5, 2, kOptional},
          {"right_wheel_radius_multiplier", &robot.right_wheel_radius_multiplier, {}, 0.5, 2, kOptional},
          {"wheel_effort_limit", &robot.wheel_effort_limit, "N·m", 0.001, 10000, kOptional},
          {"wheel_velocity_limit", &robot.wheel_velocity_limit, "rad/s", 0.01, 1000, kOptional},
          {"wheel_effort_rate", &robot.wheel_effort_rate, "N·m/s", 0.01, 1.0e9, kOptional},
          {"wheel_command", &robot.wheel_command},
          {"wheel_response_time", &robot.wheel_response_time, "s", 0.001, 1},
      },
      keys(static_cast<MachineParameters&>(robot)),
  });
}

}  // namespace robot_control
