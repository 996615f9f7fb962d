#include "simulation/machines/simulated_machine.h"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "configuration/drive_file.h"
#include "drivers/can/can_driver.h"
#include "drivers/example/example_driver.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "gate/wheeled/wheel_stop.h"
#include "simulation/devices/can_front.h"
#include "simulation/devices/example_board.h"
#include "simulation/machines/driven_plant.h"

namespace robot_control {
namespace {

CanParameters can_of(const Parameters& parameters, const DriveTrain& robot) {
  std::vector<std::string> joints;
  for (const WheelModel& wheel : robot.wheels) joints.push_back(robot.joints[wheel.joint].name);
  return read_drive_file(parameters.drives, joints, parameters.loop.rate);
}

std::unique_ptr<CanFront> can_devices(const CanParameters& can, const Parameters& parameters, const DriveTrain& robot,
                                      CanSocket socket) {
  const double period = parameters.loop.period();
  return std::make_unique<CanFront>(can, brakes_of_slow_drives(robot, period), period, parameters.plant.seed,
                                    std::move(socket));
}

/// Returns the two ends of a line, whose messages keep their borders.
std::array<int, 2> line_ends() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw DriverError(std::string("no socket for the line to the simulated drives: ") + std::strerror(errno));
  return ends;
}

/// The motors and the board of drivers/example.
struct ExampleMotors {
  ExampleParameters board;
  std::vector<Brake> brakes;
  std::vector<double> effort_limits;
};

ExampleMotors example_motors(const Parameters& parameters, const DriveTrain& robot) {
  ExampleMotors motors{
      .board = {}, .brakes = brakes_of_slow_drives(robot, parameters.loop.period()), .effort_limits = {}};
  read_driver_file(parameters.drives, "board", keys(motors.board));
  for (const WheelModel& wheel : robot.wheels) motors.effort_limits.push_back(robot.joints[wheel.joint].effort_limit);
  return motors;
}

std::unique_ptr<Driver> make_plant_behind_board(const Parameters& parameters, const DriveTrain& robot) {
  const double period = parameters.loop.period();
  const ExampleMotors motors = example_motors(parameters, robot);
  const auto [driver_end, board_end] = line_ends();
  auto board = std::make_unique<ExampleBoard>(motors.brakes, motors.effort_limits, period, board_end);
  auto driver = std::make_unique<ExampleDriver>(motors.board, motors.brakes, motors.effort_limits, robot.joints.size(),
                                                period, driver_end);
  return std::make_unique<DrivenPlant>(robot, parameters.plant, period, std::move(board), std::move(driver));
}

}  // namespace

std::unique_ptr<Driver> make_simulated_machine(const Parameters& parameters, const MachineModel& machine) {
  const double period = parameters.loop.period();
  if (parameters.driver == DriverChoice::kMujoco && parameters.drives.empty())
    return std::make_unique<MujocoPlant>(machine, parameters.plant, period);
  const DriveTrain& robot = drive_train_of(machine);
  if (parameters.driver == DriverChoice::kExample) return make_plant_behind_board(parameters, robot);
  const CanParameters can = can_of(parameters, robot);
  const auto [driver_end, device_end] = line_ends();
  std::unique_ptr<DeviceFront> devices = can_devices(can, parameters, robot, CanSocket::line_end(device_end));
  const auto clock = [front = devices.get()] { return CanTime{.time_ns = front->now_ns(), .utc_ns = front->now_ns()}; };
  auto driver = std::make_unique<CanDriver>(can, brakes_of_slow_drives(robot, period), robot.joints.size(), period,
                                            CanSocket::line_end(driver_end), clock);
  return std::make_unique<DrivenPlant>(robot, parameters.plant, period, std::move(devices), std::move(driver));
}

std::unique_ptr<DeviceSimulator> make_device_simulator(const Parameters& parameters, const MachineModel& machine) {
  const DriveTrain& robot = drive_train_of(machine);
  if (parameters.driver == DriverChoice::kExample) {
    const ExampleMotors motors = example_motors(parameters, robot);
    auto board = std::make_unique<ExampleBoard>(motors.brakes, motors.effort_limits, parameters.loop.period(),
                                                bind_board(motors.board.address));
    return std::make_unique<DeviceSimulator>(robot, parameters.plant, parameters.loop.period(), std::move(board));
  }
  const CanParameters can = can_of(parameters, robot);
  auto devices = can_devices(can, parameters, robot, CanSocket::open(can.bus.address));
  return std::make_unique<DeviceSimulator>(robot, parameters.plant, parameters.loop.period(), std::move(devices));
}

}  // namespace robot_control
