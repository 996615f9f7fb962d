#include "drivers/drive_motors.h"

#include "drivers/driver.h"

namespace robot_control {

DriveMotors drive_motors(const MachineModel& machine, const std::vector<Brake>& brakes) {
  DriveMotors motors;
  motors.brakes = brakes;
  motors.joint_count = machine.joints.size();
  for (const std::size_t joint : driven_joint_indices(machine)) {
    if (joint != motors.joints.size())
      throw DriverError("joint '" + machine.joints[motors.joints.size()].name + "' is not driven, but stands before '" +
                        machine.joints[joint].name + "': the robot's kind has to put its driven joints first");
    motors.joints.push_back(machine.joints[joint].name);
    motors.effort_limits.push_back(machine.joints[joint].effort_limit);
  }
  if (brakes.size() != motors.joints.size())
    throw DriverError("robot.driver, robot.drives: drives that take torques do not move a robot with " +
                      machine.parts() + " yet: set robot.driver to mujoco and leave robot.drives empty");
  return motors;
}

}  // namespace robot_control
