#include "drivers/unitree_go/unitree_go_file.h"

#include <algorithm>

#include "drivers/unitree/unitree_driver.h"

namespace robot_control {
namespace {

constexpr std::uint32_t kLoopback = 127;

/// Commands and states of the legs pass here without a check of their sender.
bool is_loopback(const std::string& address) {
  const std::optional<sockaddr_in> parsed = udp_address(address);
  return parsed && ntohl(parsed->sin_addr.s_addr) >> 24U == kLoopback;
}

/// A name that Linux permits and that needs no quotes in the configuration of DDS.
bool is_interface(const std::string& name) {
  constexpr std::size_t kLongest = 15;
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; };
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, plain);
}

}  // namespace

void UnitreeGoFile::check_line(GivenValues& given) const {
  const std::string block = std::string(line_block()) + ".";
  if (given.accepted(block + "address") && !is_loopback(line_.address)) {
    given.refuse(block + "address", "must be IPV4:PORT of unitree_bridge on the loopback",
                 "set 127.0.0.1:8117; the robot itself is reached by the key interface");
  }
  if (given.accepted(block + "interface") && !is_interface(line_.interface)) {
    given.refuse(block + "interface", "must be the name of a network interface",
                 "set one that `ip link` lists, such as eth0; lo for a simulated robot");
  }
}

std::unique_ptr<Driver> UnitreeGoFile::make_driver(const DriveMotors& motors, LineEnd end, DriverClock clock) const {
  return std::make_unique<UnitreeDriver<Go2>>(parameters(), motors, request().period(),
                                              std::get<std::unique_ptr<DatagramLine>>(std::move(end)),
                                              [clock = std::move(clock)] { return clock().time_ns; });
}

std::unique_ptr<DriveFile> make_unitree_go_file(DriveFileRequest request) {
  return std::make_unique<UnitreeGoFile>(std::move(request));
}

}  // namespace robot_control
