#include "simulation/machines/driven_plant.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "gate/wheeled/wheel_stop.h"
#include "simulation/devices/device_faults.h"

namespace robot_control {

DrivenPlant::DrivenPlant(const DriveTrain& robot, const MujocoPlantParameters& plant, const CanParameters& can,
                         double period)
    : plant_(robot, plant, period),
      drives_(can, brakes_of_slow_drives(robot, period), period, plant.seed),
      period_ns_(std::llround(1.0e9 * period)),
      torques_(robot.joints.size()) {
  for (std::size_t i = 0; i < drives_.size(); ++i) joints_.push_back(robot.joints[i].name);
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0)
    throw DriverError(std::string("no socket for the simulated bus: ") + std::strerror(errno));
  wire_ = ends[1];
  driver_ = std::make_unique<CanDriver>(can, brakes_of_slow_drives(robot, period), period, CanSocket(ends[0]), [this] {
    return CanTime{.time_ns = drives_.bus().now_ns(), .utc_ns = drives_.bus().now_ns()};
  });
  to_driver_.reserve(kMaxFramesPerDatagram);
  party_ = drives_.bus().join([this](const can_frame& frame, std::int64_t) {
    to_driver_.push_back(frame);
    if (to_driver_.size() == kMaxFramesPerDatagram) deliver();
  });
}

DrivenPlant::~DrivenPlant() {
  close(wire_);
}

void DrivenPlant::start() {
  plant_.start();
  plant_.truth(truth_);
  driver_->start();
  const std::vector<JointCommand> brakes(drives_.size());
  const std::int64_t end_ns = drives_.bus().now_ns() + kMaxStart;
  do {
    driver_->read(wheels_);
    driver_->write(brakes);
    run_drives();
  } while (wheels_.driver_state != DriverState::kRunning && drives_.bus().now_ns() < end_ns);
}

/// Carries the driver's frames to the bus, and runs bus and devices for one period.
void DrivenPlant::run_drives() noexcept {
  std::array<can_frame, kMaxFramesPerDatagram> frames;
  std::array<iovec, kMaxFramesPerDatagram> parts;
  std::array<mmsghdr, kMaxFramesPerDatagram> messages{};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    parts[i] = {.iov_base = &frames[i], .iov_len = sizeof(can_frame)};
    messages[i].msg_hdr.msg_iov = &parts[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  int received = 0;
  do {
    received = recvmmsg(wire_, messages.data(), kMaxFramesPerDatagram, 0, nullptr);
    for (int i = 0; i < received; ++i) drives_.bus().send(party_, frames[static_cast<std::size_t>(i)]);
  } while (received == static_cast<int>(kMaxFramesPerDatagram));
  drives_.run(truth_.joints, drives_.bus().now_ns() + period_ns_);
  deliver();
}

/// A datagram holds several frames.
void DrivenPlant::deliver() noexcept {
  if (!to_driver_.empty()) ::send(wire_, to_driver_.data(), to_driver_.size() * sizeof(can_frame), 0);
  to_driver_.clear();
}

void DrivenPlant::read(SensorFrame& sensors) noexcept {
  plant_.read(sensors);
  driver_->read(wheels_);
  if (sensors.driver_state == DriverState::kRunning) sensors.driver_state = wheels_.driver_state;
  sensors.faults |= wheels_.faults;
  std::copy_n(wheels_.joints.begin(), drives_.size(), sensors.joints.begin());
  sensors.link_count = wheels_.link_count;
  sensors.links = wheels_.links;
  if ((sensors.valid & kValidBattery) != 0 || (wheels_.valid & kValidBattery) == 0) return;
  sensors.valid |= kValidBattery;
  sensors.battery_voltage = wheels_.battery_voltage;
}

void DrivenPlant::write(std::span<const JointCommand> commands) noexcept {
  driver_->write(commands.first(std::min(drives_.size(), commands.size())));
  plant_.truth(truth_);
  run_drives();
  std::ranges::copy(commands.first(std::min(torques_.size(), commands.size())), torques_.begin());
  for (std::size_t i = 0; i < drives_.size(); ++i)
    torques_[i] = {.mode = JointMode::kEffort, .effort = drives_.torque(i)};
  plant_.write(torques_);
}

void DrivenPlant::stop() noexcept {
  driver_->stop();
  plant_.stop();
}

std::string DrivenPlant::inject_device(std::string_view component, std::string_view kind) {
  return inject_device_fault(drives_, joints_, party_, component, kind);
}

std::string DrivenPlant::warning() const {
  const std::string drives = driver_->warning();
  const std::string robot = plant_.warning();
  return drives.empty() || robot.empty() ? drives + robot : drives + "; " + robot;
}

}  // namespace robot_control
