#include "drivers/drive/can_drive_file.h"

#include "drivers/drive/can_driver.h"

namespace robot_control {

std::optional<DriveFile::Overload> CanDriveFile::overload() {
  const double rate = request().rate;
  const std::vector<std::string> buses = drives().buses();
  if (buses.size() > kMaxLinks) {
    return Overload{.key = "address",
                    .value = bus.address,
                    .rule = "the joints are on " + std::to_string(buses.size()) + " buses, at most " +
                            std::to_string(kMaxLinks) + ": correct the key bus of the joints"};
  }
  for (std::size_t i = 0; i < buses.size(); ++i) {
    if (bus_load(drives().plan(i), rate, bus.bit_rate, bus.data_rate) > max_load()) leave_out_frames();
  }
  for (std::size_t i = 0; i < buses.size(); ++i) {
    const auto problem =
        bus_load_problem(drives().plan(i), rate, bus.bit_rate, request().min_rate, max_load(), bus.data_rate);
    if (!problem) continue;
    const std::string place = buses.size() > 1 ? buses[i] + ": " : "";
    return Overload{.key = "bit_rate", .value = shortest(bus.bit_rate), .rule = place + *problem};
  }
  return {};
}

CanSockets CanDriveFile::open_buses() const {
  CanSockets sockets;
  const std::vector<std::string> buses = drives().buses();
  for (const std::string& address : buses) sockets.push_back(CanSocket::open(address, {}, bus.data_rate > 0));
  return sockets;
}

std::unique_ptr<Driver> CanDriveFile::make_driver(const DriveMotors& motors, LineEnd line, DriverClock clock) const {
  return std::make_unique<CanDriver>(bus, drives(), motors.brakes, motors.joint_count, request().period(),
                                     std::get<CanSockets>(std::move(line)), std::move(clock));
}

}  // namespace robot_control
