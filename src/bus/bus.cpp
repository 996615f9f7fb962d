#include "bus/bus.h"

#include <algorithm>
#include <cctype>

#include "signals/checksum.h"

namespace robot_control {
namespace {

std::uint64_t hash_of(const std::string& text) noexcept {
  Checksum sum;
  sum.mix(text);
  return sum.sum();
}

/// "http://host:11311/" → "11311"
std::string port_of(const std::string& uri) {
  const std::size_t scheme = uri.find("://");
  const std::size_t host = scheme == std::string::npos ? 0 : scheme + 3;
  const std::string authority = uri.substr(host, uri.find('/', host) - host);
  const std::size_t colon = authority.rfind(':');
  if (colon == std::string::npos || colon + 1 == authority.size()) return "11311";
  const std::string port = authority.substr(colon + 1);
  const bool is_number = std::all_of(port.begin(), port.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return is_number ? port : "11311";  // the colon of an IPv6 address
}

/// Without slashes at its ends.
std::string normalised(const std::string& name_space) {
  const std::size_t first = name_space.find_first_not_of('/');
  if (first == std::string::npos) return {};
  return name_space.substr(first, name_space.find_last_not_of('/') + 1 - first);
}

}  // namespace

std::string bus_name(const std::string& master_uri, const std::string& name_space) {
  return hex(hash_of(port_of(master_uri) + "\n/" + normalised(name_space)));
}

void announce_robot(ChannelHead& own, std::uint64_t hash, const std::string& source) noexcept {
  own.robot_hash.store(0, std::memory_order_release);
  const std::size_t length = std::min(source.size(), own.robot_source.size() - 1);
  for (std::size_t i = 0; i < own.robot_source.size(); ++i) {
    own.robot_source[i].store(i < length ? source[i] : '\0', std::memory_order_release);
  }
  own.robot_hash.store(hash, std::memory_order_release);
}

AnnouncedRobot announced_robot(const ChannelHead& head) {
  const std::uint64_t hash = head.robot_hash.load(std::memory_order_acquire);
  AnnouncedRobot robot;
  if (hash == 0) return robot;
  for (const std::atomic<char>& byte : head.robot_source) {
    const char c = byte.load(std::memory_order_acquire);
    if (c == '\0') break;
    robot.source += c;
  }
  if (head.robot_hash.load(std::memory_order_relaxed) != hash) return {};  // another driver speaks just now
  robot.hash = hash;
  return robot;
}

bool same_robot(const ChannelHead& sensors, std::uint64_t hash, const std::string& source) {
  const AnnouncedRobot robot = announced_robot(sensors);
  if (robot.hash == 0) return false;
  if (robot.hash == hash) return true;
  throw BusError("the driver was started with another robot or rate: it has '" + robot.source + "' (" +
                 hex(robot.hash) + "), this node '" + source + "' (" + hex(hash) +
                 "); remedy: restart all nodes with one robot_description and one robot: block");
}

}  // namespace robot_control
