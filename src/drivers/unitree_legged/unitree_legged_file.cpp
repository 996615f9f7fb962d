#include "drivers/unitree_legged/unitree_legged_file.h"

#include "drivers/unitree_legged/unitree_legged_driver.h"

namespace robot_control {

void UnitreeLeggedFile::check_line(GivenValues& given) const {
  const std::string block = std::string(line_block()) + ".";
  if (given.accepted(block + "robot") && line_.robot != LeggedRobot::kGo1) {
    given.refuse(block + "robot", "must be go1: this robot packs its messages in an older way, which is not known here",
                 "move it with the software of its maker");
  }
  if (given.accepted(block + "address") && !udp_address(line_.address)) {
    given.refuse(block + "address", "must be IPV4:PORT of the robot's low level",
                 "set 192.168.123.10:8007 for a Go1, 127.0.0.1:8007 for a simulated one");
  }
}

std::unique_ptr<Driver> UnitreeLeggedFile::make_driver(const DriveMotors& motors, LineEnd end,
                                                       DriverClock clock) const {
  return std::make_unique<UnitreeLeggedDriver>(parameters(), motors, request().period(),
                                               std::get<std::unique_ptr<DatagramLine>>(std::move(end)),
                                               [clock = std::move(clock)] { return clock().time_ns; });
}

std::unique_ptr<DriveFile> make_unitree_legged_file(DriveFileRequest request) {
  return std::make_unique<UnitreeLeggedFile>(std::move(request));
}

}  // namespace robot_control
