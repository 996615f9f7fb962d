#include "drivers/table/factory.h"

#include <algorithm>
#include <string>

#include "drivers/drive_motors.h"
#include "drivers/table/drive_table.h"
#include "drivers/table/read_drive_file.h"

namespace robot_control {
namespace {

/// For a driver that moves the driven joints alone.
void refuse_held_joints(const MachineModel& machine, const std::string& driver) {
  for (const JointModel& joint : machine.joints) {
    if (joint.role == JointRole::kHeld)
      throw DriverError("joint '" + joint.name + "' must be held, but robot.driver: " + driver +
                        " moves only the joints that the controller drives: remove the actuator of the joint from the "
                        "URDF, or hold it with another controller");
  }
}

}  // namespace

std::unique_ptr<Driver> make_driver(const Parameters& parameters, const MachineModel& machine,
                                    const std::vector<Brake>& brakes, const DriverClock& clock) {
  if (parameters.driver == DriverName::kMujoco)
    throw DriverError(
        "robot.driver is mujoco, which is the program mujoco_plant: start mujoco_plant, or set robot.driver "
        "(_driver:=can)");
  const std::string driver = word_of(parameters.driver);
  if (parameters.drives.empty())
    throw DriverError("robot.driver is " + driver +
                      ", but robot.drives names no drive file: set it, for example to config/drives/" +
                      std::string(std::ranges::find(kDriveRows, driver, &DriveRow::driver)->name) + ".yaml");
  refuse_held_joints(machine, driver);
  const DriveMotors motors = drive_motors(machine, brakes);
  const std::unique_ptr<DriveFile> file = read_drive_file(parameters, motors.joints);
  return file->make_driver(motors, file->open_line(parameters.loop.realtime, clock), clock);
}

}  // namespace robot_control
