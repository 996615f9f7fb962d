#include "drivers/factory/factory.h"

#include <array>
#include <string>
#include <utility>

#include "configuration/drive_file.h"
#include "drivers/can/can_driver.h"
#include "drivers/drive_motors.h"
#include "drivers/example/example_driver.h"
#include "drivers/serial/board_driver.h"
#include "drivers/serial/roboclaw_driver.h"
#include "drivers/serial/serial_port.h"

namespace robot_control {
namespace {

constexpr int kSerialPriority = 84;  // above the loop: it only takes bytes, at the time of their arrival

/// For a driver that moves the driven joints alone.
void refuse_held_joints(const MachineModel& machine, const std::string& driver) {
  for (const JointModel& joint : machine.joints) {
    if (joint.role == JointRole::kHeld)
      throw DriverError("joint '" + joint.name + "' is to be held, and robot.driver: " + driver +
                        " moves only the joints that the controller drives: give the joint no actuator in the "
                        "description, or hold it by "
                        "another controller");
  }
}

void require_drive_file(const Parameters& parameters, const std::string& driver, const std::string& example) {
  if (parameters.drives.empty())
    throw DriverError("robot.driver is " + driver +
                      ", but robot.drives names no drive file: set it, for instance to config/drives/" + example +
                      ".yaml");
}

std::unique_ptr<Driver> make_can(const Parameters& parameters, const MachineModel& machine,
                                 const std::vector<Brake>& brakes, DriverClock clock) {
  require_drive_file(parameters, "can", "odrive");
  refuse_held_joints(machine, "can");
  const DriveMotors motors = drive_motors(machine, brakes);
  const CanParameters can = read_drive_file(parameters, motors.joints);
  return std::make_unique<CanDriver>(can, motors.brakes, motors.joint_count, parameters.loop.period(),
                                     CanSocket::open(can.bus.address), std::move(clock));
}

std::unique_ptr<Driver> make_example(const Parameters& parameters, const MachineModel& machine,
                                     const std::vector<Brake>& brakes, DriverClock /*clock*/) {
  refuse_held_joints(machine, "example");
  const DriveMotors motors = drive_motors(machine, brakes);
  const auto board = read_driver_file<ExampleParameters>(parameters.drives, "board");
  return std::make_unique<ExampleDriver>(board, motors.brakes, motors.effort_limits, motors.joint_count,
                                         parameters.loop.period(), connect_to_board(board.address));
}

template <class Line>
std::unique_ptr<SerialLine> open_line(const Parameters& parameters, const Line& line,
                                      const std::function<std::int64_t()>& clock) {
  const RealtimeParameters thread{
      .name = "serial", .policy = parameters.loop.realtime, .priority = kSerialPriority, .core = -1};
  return std::make_unique<SerialPort>(line.address, static_cast<unsigned>(line.bit_rate), thread, clock);
}

std::unique_ptr<Driver> make_board(const Parameters& parameters, const MachineModel& machine,
                                   const std::vector<Brake>& brakes, DriverClock clock) {
  require_drive_file(parameters, "board", "board");
  refuse_held_joints(machine, "board");
  const DriveMotors motors = drive_motors(machine, brakes);
  const BoardParameters board = read_board_file(parameters, motors.joints);
  const auto time_ns = [clock = std::move(clock)] { return clock().time_ns; };
  return std::make_unique<BoardDriver>(board, motors.brakes, motors.joint_count, parameters.loop.period(),
                                       open_line(parameters, board.line, time_ns), time_ns);
}

std::unique_ptr<Driver> make_roboclaw(const Parameters& parameters, const MachineModel& machine,
                                      const std::vector<Brake>& brakes, DriverClock clock) {
  require_drive_file(parameters, "roboclaw", "roboclaw");
  refuse_held_joints(machine, "roboclaw");
  const DriveMotors motors = drive_motors(machine, brakes);
  const RoboclawParameters board = read_roboclaw_file(parameters, motors.joints);
  const auto time_ns = [clock = std::move(clock)] { return clock().time_ns; };
  return std::make_unique<RoboclawDriver>(board, motors.joint_count, parameters.loop.period(),
                                          open_line(parameters, board.line, time_ns), time_ns);
}

struct DriverRow {
  DriverChoice choice;
  std::unique_ptr<Driver> (*make)(const Parameters&, const MachineModel&, const std::vector<Brake>&, DriverClock);
};

constexpr std::array kDrivers{
    DriverRow{DriverChoice::kCan, &make_can}, DriverRow{DriverChoice::kExample, &make_example},
    DriverRow{DriverChoice::kBoard, &make_board}, DriverRow{DriverChoice::kRoboclaw, &make_roboclaw}};

}  // namespace

std::unique_ptr<Driver> make_driver(const Parameters& parameters, const MachineModel& machine,
                                    const std::vector<Brake>& brakes, DriverClock clock) {
  for (const DriverRow& row : kDrivers) {
    if (row.choice == parameters.driver) return row.make(parameters, machine, brakes, std::move(clock));
  }
  throw DriverError(
      "robot.driver is mujoco, which is the program mujoco_plant: start that one, or set robot.driver "
      "(_driver:=can)");
}

}  // namespace robot_control
