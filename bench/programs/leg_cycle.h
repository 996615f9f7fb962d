#pragma once
/// The cost of one cycle of the driver of quadbot's twelve motors: its `read` and its `write`, with the system calls of
/// its lines. These are a socket pair for each CAN bus, or UDP over the loopback.

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "drivers/drive/datagram_drive_file.h"
#include "drivers/drive_motors.h"
#include "drivers/table/simulated_front.h"
#include "rt/clock.h"
#include "support/allocation_guard.h"

namespace robot_control::bench {

/// Adds the rows of one drive file.
inline void add_leg_cycle(std::vector<Row>& rows, const std::string& name, const DriveFile& file,
                          const DriveMotors& motors) {
  constexpr int kCycles = 20'000;
  constexpr int kStart = 3'000;  // until the drives run
  constexpr double kAllowed = 20'000;
  const std::string robot = "127.0.0.1:18117";
  constexpr std::uint16_t kHostPort = 18118;
  const bool is_udp = dynamic_cast<const DatagramDriveFile*>(&file) != nullptr;
  std::optional<LineEnd> devices_end;
  if (is_udp) devices_end = UdpSocket::device_end(robot);
  const auto devices = make_front(file, {.motors = motors, .line = std::move(devices_end)});
  const auto driver =
      file.make_driver(motors, is_udp ? LineEnd(UdpSocket::host_end(robot, kHostPort)) : devices->driver_end(),
                       [&devices] { return CanTime{.time_ns = devices->now_ns(), .utc_ns = devices->now_ns()}; });
  std::vector<JointSample> joints(motors.joint_count);
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].position = file.start_angle(i).value_or(0);
  const std::vector<JointCommand> commands(motors.joint_count, {.mode = JointMode::kImpedance, .stiffness = 20});
  SensorFrame sensors;
  std::vector<double> cycle_ns;
  std::uint64_t allocations = 0;
  driver->start();
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    const std::int64_t start_ns = monotonic_ns();
    {
      const AllocationGuard guard;
      driver->read(sensors);
      driver->write(commands);
      if (cycle >= kStart) allocations += guard.count();
    }
    if (cycle >= kStart) cycle_ns.push_back(static_cast<double>(monotonic_ns() - start_ns));
    devices->run(joints);
  }
  if (sensors.driver_state != DriverState::kRunning) throw std::runtime_error(name + ": " + driver->warning());
  rows.push_back({name + " cycle of twelve motors", median(cycle_ns), "ns", kAllowed, "what is allowed",
                  median(cycle_ns) / kAllowed});
  rows.push_back({name + " allocations", static_cast<double>(allocations), "per 17000 cycles", 0, "none", 0});
}

}  // namespace robot_control::bench
