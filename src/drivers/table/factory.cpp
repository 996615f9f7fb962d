#include "drivers/table/factory.h"

#include <array>
#include <string>
#include <utility>

#include "drivers/table/drive_file.h"
#include "drivers/drive/can_driver.h"
#include "drivers/drive_motors.h"
#include "drivers/board/board_driver.h"
#include "drivers/roboclaw/roboclaw_driver.h"
#include "drivers/line/serial_port.h"

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

/// `read` returns the drive file, and `make` the driver of such a board from file, motors, line and clock.
template <class Read, class Make>
std::unique_ptr<Driver> make_serial(const std::string& driver, const Parameters& parameters,
                                    const MachineModel& machine, const std::vector<Brake>& brakes, DriverClock clock,
                                    Read read, Make make) {
  require_drive_file(parameters, driver, driver);
  refuse_held_joints(machine, driver);
  const DriveMotors motors = drive_motors(machine, brakes);
  const auto file = read(parameters, motors.joints);
  const std::function<std::int64_t()> time_ns = [clock = std::move(clock)] { return clock().time_ns; };
  const RealtimeParameters thread{
      .name = "serial", .policy = parameters.loop.realtime, .priority = kSerialPriority, .core = -1};
  const auto bit_rate = static_cast<unsigned>(file.line.bit_rate);
  return make(file, motors, std::make_unique<SerialPort>(file.line.address, bit_rate, thread, time_ns), time_ns);
}

std::unique_ptr<Driver> make_board(const Parameters& parameters, const MachineModel& machine,
                                   const std::vector<Brake>& brakes, DriverClock clock) {
  const auto make = [&](const BoardParameters& file, const DriveMotors& motors, auto line, const auto& time_ns) {
    return std::make_unique<BoardDriver>(file, motors.brakes, motors.joint_count, parameters.loop.period(),
                                         std::move(line), time_ns);
  };
  const auto read = [](const auto&... from) { return read_board_file(from...); };
  return make_serial("board", parameters, machine, brakes, std::move(clock), read, make);
}

std::unique_ptr<Driver> make_roboclaw(const Parameters& parameters, const MachineModel& machine,
                                      const std::vector<Brake>& brakes, DriverClock clock) {
  const auto make = [&](const RoboclawParameters& file, const DriveMotors& motors, auto line, const auto& time_ns) {
    return std::make_unique<RoboclawDriver>(file, motors.joint_count, parameters.loop.period(), std::move(line),
                                            time_ns);
  };
  return make_serial("roboclaw", parameters, machine, brakes, std::move(clock), &read_roboclaw_file, make);
}

struct DriverRow {
  DriverChoice choice;
  std::unique_ptr<Driver> (*make)(const Parameters&, const MachineModel&, const std::vector<Brake>&, DriverClock);
};

constexpr std::array kDrivers{DriverRow{DriverChoice::kCan, &make_can}, DriverRow{DriverChoice::kBoard, &make_board},
                              DriverRow{DriverChoice::kRoboclaw, &make_roboclaw}};

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
