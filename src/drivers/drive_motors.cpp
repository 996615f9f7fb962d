#include "drivers/drive_motors.h"

#include "drivers/driver.h"

namespace robot_control {

DriveMotors drive_motors(const MachineModel& machine, const std::vector<Brake>& brakes) {
  DriveMotors motors;
  motors.brakes = brakes;
  motors.joint_count = machine.joints.size();
  for (const std::size_t joint : driven_joint_indices(machine)) {
    motors.joints.push_back(machine.joints[joint].name);
    motors.effort_limits.push_back(machine.joints[joint].effort_limit);
  }
  if (brakes.size() != motors.joints.size())
    throw DriverError("robot.driver: no driver of real drives moves a robot with " + machine.parts() +
                      " yet: leave robot.driver at mujoco and robot.drives empty");
  return motors;
}

}  // namespace robot_control
