#include "simulation/machines/simulated_machine.h"

#include <algorithm>

#include "drivers/drive_motors.h"
#include "drivers/table/read_drive_file.h"
#include "drivers/table/simulated_front.h"

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
  if (devices_->reports_imu()) {
    plant_.read(sensors_);
    devices_->sense(sensors_.imu);
  }
  devices_->run(truth_.joints);
  for (std::size_t i = 0; i < devices_->size(); ++i)
    torques_[i] = {.mode = JointMode::kEffort, .effort = devices_->torque(i)};
  plant_.write(torques_);
  plant_.truth(truth_);
  published_truth_.store(truth_);
}

DrivenPlant::DrivenPlant(const MachineModel& robot, const MujocoPlantParameters& plant, double period,
                         std::unique_ptr<DeviceFront> devices, std::unique_ptr<Driver> driver)
    : plant_(robot, plant, period),
      devices_(std::move(devices)),
      driver_(std::move(driver)),
      seen_(devices_->size()),
      turned_(devices_->size()),
      torques_(robot.joints.size()) {
  if (plant.drive == SimulatedDrive::kTorque) return;
  throw DriverError(
      "the simulated machine's parameter drive is velocity, but robot.drives names devices that turn the motors. Set "
      "drive to torque, or leave robot.drives out.");
}

void DrivenPlant::run_devices() noexcept {
  std::copy_n(truth_.joints.begin(), seen_.size(), seen_.begin());
  for (std::size_t i = 0; i < seen_.size(); ++i) seen_[i].position += turned_[i];
  devices_->run(seen_);
}

void DrivenPlant::find_joints(std::span<const JointCommand> brakes) noexcept {
  constexpr int kExchanges = 5;  // All answers of a drive are lost once in 10⁶ at a loss of 5 %.
  for (int i = 0; i < kExchanges; ++i) {
    driver_->write(brakes);
    run_devices();
    driver_->read(wheels_);
  }
}

void DrivenPlant::start() {
  plant_.start();
  plant_.truth(truth_);
  const std::vector<JointCommand> brakes(torques_.size());
  if (devices_->is_absolute()) {
    find_joints(brakes);
  } else {
    // The motors go on from where they are, whatever the joints of the new run are.
    for (std::size_t i = 0; i < turned_.size(); ++i) turned_[i] = seen_[i].position - truth_.joints[i].position;
  }
  driver_->start();
  if (devices_->reports_imu()) {
    plant_.read(wheels_);
    devices_->sense(wheels_.imu);
  }
  const std::int64_t end_ns = devices_->now_ns() + kMaxStart;
  do {
    driver_->read(wheels_);
    driver_->write(brakes);
    run_devices();
  } while (wheels_.driver_state != DriverState::kRunning && devices_->now_ns() < end_ns);
}

void DrivenPlant::pass_imu(SensorFrame& sensors) noexcept {
  constexpr std::uint64_t kImu = kValidGyro | kValidAccelerometer | kValidOrientation;
  devices_->sense(sensors.imu);
  sensors.imu = wheels_.imu;
  sensors.valid &= wheels_.valid | ~kImu;
}

void DrivenPlant::read(SensorFrame& sensors) noexcept {
  plant_.read(sensors);
  driver_->read(wheels_);
  if (devices_->reports_imu()) pass_imu(sensors);
  if (sensors.driver_state == DriverState::kRunning) sensors.driver_state = wheels_.driver_state;
  sensors.faults |= wheels_.faults;
  std::copy_n(wheels_.joints.begin(), devices_->size(), sensors.joints.begin());
  sensors.link_count = wheels_.link_count;
  sensors.links = wheels_.links;
  sensors.digital_inputs |= wheels_.digital_inputs;
  if ((sensors.valid & kValidBattery) != 0 || (wheels_.valid & kValidBattery) == 0) return;
  sensors.valid |= kValidBattery;
  sensors.battery_voltage = wheels_.battery_voltage;
}

void DrivenPlant::write(std::span<const JointCommand> commands) noexcept {
  driver_->write(commands);
  plant_.truth(truth_);
  run_devices();
  std::ranges::copy(commands.first(std::min(torques_.size(), commands.size())), torques_.begin());
  for (std::size_t i = 0; i < devices_->size(); ++i)
    torques_[i] = {.mode = JointMode::kEffort, .effort = devices_->torque(i)};
  plant_.write(torques_);
}

void DrivenPlant::stop() noexcept {
  driver_->stop();
  plant_.stop();
}

std::string DrivenPlant::warning() const {
  const std::string drives = driver_->warning();
  const std::string robot = plant_.warning();
  return drives.empty() || robot.empty() ? drives + robot : drives + "; " + robot;
}

}  // namespace robot_control
