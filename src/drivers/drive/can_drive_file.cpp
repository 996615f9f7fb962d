#include "drivers/drive/can_drive_file.h"

#include "drivers/drive/can_driver.h"
#include "drivers/line/can_load.h"

namespace robot_control {

std::optional<DriveFile::Overload> CanDriveFile::overload() {
  const double rate = request().rate;
  if (bus_load(drives().plan(), rate, bus.bit_rate) > kMaxBusLoad) leave_out_frames();
  const auto problem = bus_load_problem(drives().plan(), rate, bus.bit_rate, request().min_rate);
  if (!problem) return {};
  return Overload{.key = "bit_rate", .value = shortest(bus.bit_rate), .rule = *problem};
}

std::unique_ptr<Driver> CanDriveFile::make_driver(const DriveMotors& motors, LineEnd line, DriverClock clock) const {
  return std::make_unique<CanDriver>(bus, drives(), motors.brakes, motors.joint_count, request().period(),
                                     std::get<CanSocket>(std::move(line)), std::move(clock));
}

}  // namespace robot_control
