#include "simulation/machines/simulated_machine.h"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "drivers/table/drive_file.h"
#include "drivers/drive/can_driver.h"
#include "drivers/drive_motors.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "drivers/board/board_driver.h"
#include "drivers/roboclaw/roboclaw_driver.h"
#include "drivers/drive/can_front.h"
#include "drivers/board/board_front.h"
#include "drivers/line/pseudo_terminal.h"
#include "drivers/roboclaw/roboclaw_front.h"
#include "simulation/machines/driven_plant.h"

namespace robot_control {
namespace {

std::unique_ptr<CanFront> can_devices(const CanParameters& can, const Parameters& parameters, const DriveMotors& motors,
                                      CanSocket socket) {
  return std::make_unique<CanFront>(can, motors.brakes, parameters.loop.period(), parameters.plant.seed,
                                    std::move(socket));
}

/// Returns the two ends of a line, whose messages keep their borders.
std::array<int, 2> line_ends() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw DriverError(std::string("no socket for the line to the simulated drives: ") + std::strerror(errno));
  return ends;
}

std::unique_ptr<Driver> make_plant_behind_serial(const Parameters& parameters, const MachineModel& machine,
                                                 const DriveMotors& motors) {
  const double period = parameters.loop.period();
  const BoardParameters board = read_board_file(parameters, motors.joints);
  auto front = std::make_unique<BoardFront>(board, motors.brakes, period, parameters.plant.seed);
  auto driver = std::make_unique<BoardDriver>(board, motors.brakes, motors.joint_count, period, front->driver_end(),
                                              [clock = front.get()] { return clock->now_ns(); });
  return std::make_unique<DrivenPlant>(machine, parameters.plant, period, std::move(front), std::move(driver));
}

std::unique_ptr<Driver> make_plant_behind_roboclaw(const Parameters& parameters, const MachineModel& machine,
                                                   const DriveMotors& motors) {
  const double period = parameters.loop.period();
  const RoboclawParameters board = read_roboclaw_file(parameters, motors.joints);
  auto front =
      std::make_unique<RoboclawFront>(board, motors.brakes, motors.effort_limits, period, parameters.plant.seed);
  auto driver = std::make_unique<RoboclawDriver>(board, motors.joint_count, period, front->driver_end(),
                                                 [clock = front.get()] { return clock->now_ns(); });
  return std::make_unique<DrivenPlant>(machine, parameters.plant, period, std::move(front), std::move(driver));
}

}  // namespace

std::unique_ptr<Driver> make_simulated_machine(const Parameters& parameters, const MachineModel& machine,
                                               const std::vector<Brake>& brakes) {
  const double period = parameters.loop.period();
  if (parameters.driver == DriverChoice::kMujoco && parameters.drives.empty())
    return std::make_unique<MujocoPlant>(machine, parameters.plant, period);
  const DriveMotors motors = drive_motors(machine, brakes);
  if (parameters.driver == DriverChoice::kBoard) return make_plant_behind_serial(parameters, machine, motors);
  if (parameters.driver == DriverChoice::kRoboclaw) return make_plant_behind_roboclaw(parameters, machine, motors);
  const CanParameters can = read_drive_file(parameters, motors.joints);
  const auto [driver_end, device_end] = line_ends();
  std::unique_ptr<DeviceFront> devices = can_devices(can, parameters, motors, CanSocket::line_end(device_end));
  const auto clock = [front = devices.get()] { return CanTime{.time_ns = front->now_ns(), .utc_ns = front->now_ns()}; };
  auto driver = std::make_unique<CanDriver>(can, motors.brakes, motors.joint_count, period,
                                            CanSocket::line_end(driver_end), clock);
  return std::make_unique<DrivenPlant>(machine, parameters.plant, period, std::move(devices), std::move(driver));
}

std::unique_ptr<DeviceSimulator> make_device_simulator(const Parameters& parameters, const MachineModel& machine,
                                                       const std::vector<Brake>& brakes) {
  const double period = parameters.loop.period();
  const DriveMotors motors = drive_motors(machine, brakes);
  if (parameters.driver == DriverChoice::kBoard) {
    const BoardParameters board = read_board_file(parameters, motors.joints);
    auto front = std::make_unique<BoardFront>(board, motors.brakes, period,
                                              std::make_unique<PseudoTerminal>(board.line.address));
    return std::make_unique<DeviceSimulator>(machine, parameters.plant, period, std::move(front));
  }
  if (parameters.driver == DriverChoice::kRoboclaw) {
    const RoboclawParameters board = read_roboclaw_file(parameters, motors.joints);
    auto front = std::make_unique<RoboclawFront>(board, motors.brakes, motors.effort_limits, period,
                                                 std::make_unique<PseudoTerminal>(board.line.address));
    return std::make_unique<DeviceSimulator>(machine, parameters.plant, period, std::move(front));
  }
  const CanParameters can = read_drive_file(parameters, motors.joints);
  auto devices = can_devices(can, parameters, motors, CanSocket::open(can.bus.address));
  return std::make_unique<DeviceSimulator>(machine, parameters.plant, period, std::move(devices));
}

}  // namespace robot_control
