#include "robots/wheeled/within_drives.h"

#include <limits>

#include "drivers/table/read_drive_file.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {
namespace {

/// The smallest limit of the wheels, and that of their drives with the joint to which it belongs.
struct Smallest {
  double of_robot = std::numeric_limits<double>::infinity();
  double of_drives = of_robot;
  std::string joint{};

  void include(double robot, double drive, const std::string& name) {
    if (robot > 0) of_robot = std::min(of_robot, robot);
    if (drive >= of_drives) return;
    of_drives = drive;
    joint = name;
  }
};

void lower(std::optional<double>& limit, const Smallest& smallest, const std::string& key, const std::string& unit,
           Parameters& parameters) {
  if (smallest.of_drives >= smallest.of_robot) return;
  limit = smallest.of_drives;
  parameters.warnings.push_back("robot.wheel_" + key + " = " + shortest(*limit) + " " + unit + ", which the drive of " +
                                smallest.joint + " has in " + parameters.drives + ": the robot plans within it");
}

}  // namespace

Parameters within_drives(Parameters parameters, const RobotDescription& description) {
  const DriveTrain robot = read_drive_train(description, parameters.robot);
  std::vector<std::string> joints;
  for (const WheelModel& wheel : robot.wheels) joints.push_back(robot.joints[wheel.joint].name);
  const std::unique_ptr<DriveFile> file = read_drive_file(parameters, joints);
  Smallest velocity, torque, rate;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointModel& joint = robot.joints[robot.wheels[i].joint];
    const DriveCapability drive = file->capability(i);
    velocity.include(joint.velocity_limit, drive.velocity, joint.name);
    torque.include(joint.effort_limit, drive.torque, joint.name);
    rate.include(joint.effort_rate, drive.torque_rate, joint.name);
  }
  lower(parameters.robot.wheel_velocity_limit, velocity, "velocity_limit", "rad/s", parameters);
  lower(parameters.robot.wheel_effort_limit, torque, "effort_limit", "N·m", parameters);
  lower(parameters.robot.wheel_effort_rate, rate, "effort_rate", "N·m/s", parameters);
  return parameters;
}

}  // namespace robot_control
