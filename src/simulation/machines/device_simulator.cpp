#include "simulation/machines/device_simulator.h"

namespace robot_control {

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
