#include "simulation/machines/device_simulator.h"

#include <cmath>

#include "gate/wheeled/wheel_stop.h"
#include "simulation/devices/device_faults.h"

namespace robot_control {

DeviceSimulator::DeviceSimulator(const DriveTrain& robot, const MujocoPlantParameters& plant, const CanParameters& can,
                                 double period)
    : plant_(robot, plant, period),
      drives_(can, brakes_of_slow_drives(robot, period), period, plant.seed),
      bus_(CanSocket::open(can.bus.address)),
      period_ns_(std::llround(1.0e9 * period)),
      party_(drives_.bus().join([this](const can_frame& frame, std::int64_t) { to_host_.push_back(frame); })),
      torques_(robot.joints.size()) {
  for (std::size_t i = 0; i < drives_.size(); ++i) joints_.push_back(robot.joints[i].name);
  plant_.start();
  plant_.truth(truth_);
}

std::string DeviceSimulator::inject(std::string_view component, std::string_view kind) {
  return inject_device_fault(drives_, joints_, party_, component, kind);
}

void DeviceSimulator::step() noexcept {
  const std::int64_t now_ns = drives_.bus().now_ns();
  for (bool more = true; more;) {
    const ReceivedFrames received = bus_.receive({.time_ns = now_ns, .utc_ns = now_ns});
    for (const ReceivedFrame& each : received.frames) drives_.bus().send(party_, each.frame);
    more = received.more;
  }
  drives_.run(truth_.joints, now_ns + period_ns_);
  for (std::size_t i = 0; i < drives_.size(); ++i)
    torques_[i] = {.mode = JointMode::kEffort, .effort = drives_.torque(i)};
  plant_.write(torques_);
  plant_.truth(truth_);
  bus_.send(to_host_);
  to_host_.clear();
}

}  // namespace robot_control
