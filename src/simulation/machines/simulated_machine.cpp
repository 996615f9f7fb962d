#include "simulation/machines/simulated_machine.h"

#include "drivers/drive_motors.h"
#include "drivers/table/read_drive_file.h"
#include "drivers/table/simulated_front.h"
#include "simulation/machines/driven_plant.h"

namespace robot_control {

std::unique_ptr<Driver> make_simulated_machine(const Parameters& parameters, const MachineModel& machine,
                                               const std::vector<Brake>& brakes) {
  const double period = parameters.loop.period();
  if (parameters.driver == DriverName::kMujoco && parameters.drives.empty())
    return std::make_unique<MujocoPlant>(machine, parameters.plant, period);
  const DriveMotors motors = drive_motors(machine, brakes);
  const std::unique_ptr<DriveFile> file = read_drive_file(parameters, motors.joints);
  std::unique_ptr<DeviceFront> devices = make_front(*file, {.motors = motors, .seed = parameters.plant.seed});
  auto driver = file->make_driver(motors, devices->driver_end(), [front = devices.get()] {
    return CanTime{.time_ns = front->now_ns(), .utc_ns = front->now_ns()};
  });
  return std::make_unique<DrivenPlant>(machine, parameters.plant, period, std::move(devices), std::move(driver));
}

std::unique_ptr<DeviceSimulator> make_device_simulator(const Parameters& parameters, const MachineModel& machine,
                                                       const std::vector<Brake>& brakes) {
  const DriveMotors motors = drive_motors(machine, brakes);
  const std::unique_ptr<DriveFile> file = read_drive_file(parameters, motors.joints);
  auto devices = make_front(*file, {.motors = motors, .seed = parameters.plant.seed, .line = open_devices_end(*file)});
  return std::make_unique<DeviceSimulator>(machine, parameters.plant, parameters.loop.period(), std::move(devices));
}

DeviceSimulator::DeviceSimulator(const MachineModel& robot, const MujocoPlantParameters& plant, double period,
                                 std::unique_ptr<DeviceFront> devices)
    : plant_(robot, plant, period), devices_(std::move(devices)), torques_(robot.joints.size()) {
  plant_.start();
  plant_.truth(truth_);
  published_truth_.store(truth_);
}

void DeviceSimulator::step() noexcept {
  devices_->run(truth_.joints);
  for (std::size_t i = 0; i < devices_->size(); ++i)
    torques_[i] = {.mode = JointMode::kEffort, .effort = devices_->torque(i)};
  plant_.write(torques_);
  plant_.truth(truth_);
  published_truth_.store(truth_);
}

}  // namespace robot_control
