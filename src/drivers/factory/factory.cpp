#include "drivers/factory/factory.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "configuration/drive_file.h"
#include "drivers/can/can_driver.h"
#include "drivers/example/example_driver.h"
#include "gate/wheeled/wheel_stop.h"

namespace robot_control {
namespace {

/// Both drivers move the wheels alone.
void refuse_held_joints(const DriveTrain& robot, const std::string& driver) {
  for (const JointModel& joint : robot.joints) {
    if (joint.role == JointRole::kHeld)
      throw DriverError("joint '" + joint.name + "' is to be held, and the driver " + driver +
                        " drives the wheels alone: give the joint no actuator in the description, or hold it by "
                        "another controller");
  }
}

std::unique_ptr<Driver> make_can(const Parameters& parameters, const DriveTrain& robot, DriverClock clock) {
  if (parameters.drives.empty())
    throw DriverError(
        "robot.driver is can, but robot.drives names no drive file: set it, for instance to "
        "config/drives/odrive.yaml");
  std::vector<std::string> joints;
  for (const WheelModel& wheel : robot.wheels) joints.push_back(robot.joints[wheel.joint].name);
  refuse_held_joints(robot, "can");
  const CanParameters can = read_drive_file(parameters.drives, joints, parameters.loop.rate);
  const double period = parameters.loop.period();
  return std::make_unique<CanDriver>(can, brakes_of_slow_drives(robot, period), robot.joints.size(), period,
                                     CanSocket::open(can.bus.address), std::move(clock));
}

std::unique_ptr<Driver> make_example(const Parameters& parameters, const DriveTrain& robot, DriverClock /*clock*/) {
  ExampleParameters board;
  read_driver_file(parameters.drives, "board", keys(board));
  std::vector<double> effort_limits;
  for (const WheelModel& wheel : robot.wheels) effort_limits.push_back(robot.joints[wheel.joint].effort_limit);
  const double period = parameters.loop.period();
  refuse_held_joints(robot, "example");
  return std::make_unique<ExampleDriver>(board, brakes_of_slow_drives(robot, period), effort_limits,
                                         robot.joints.size(), period, connect_to_board(board.address));
}

struct DriverRow {
  DriverChoice choice;
  std::unique_ptr<Driver> (*make)(const Parameters&, const DriveTrain&, DriverClock);
};

constexpr std::array kDrivers{DriverRow{DriverChoice::kCan, &make_can},
                              DriverRow{DriverChoice::kExample, &make_example}};

}  // namespace

std::unique_ptr<Driver> make_driver(const Parameters& parameters, const DriveTrain& robot, DriverClock clock) {
  for (const DriverRow& row : kDrivers) {
    if (row.choice == parameters.driver) return row.make(parameters, robot, std::move(clock));
  }
  throw DriverError(
      "robot.driver is mujoco, which is the program mujoco_plant: start that one, or set robot.driver "
      "(_driver:=can)");
}

}  // namespace robot_control
