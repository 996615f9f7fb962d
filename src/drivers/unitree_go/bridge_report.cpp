#include "drivers/unitree_go/bridge_report.h"

#include <cstring>

namespace robot_control::unitree::go {

bool read_report(std::span<const std::uint8_t> bytes, BridgeReport& report) noexcept {
  BridgeReport read;
  if (bytes.size() < kReportBytes) return false;
  std::memcpy(&read, bytes.data(), kReportBytes);
  if (read.magic != BridgeReport::kMagic || read.robots > RobotsSeen::kMore || read.service > MotionService::kNone)
    return false;
  read.mode.back() = '\0';
  for (char& c : read.mode) {
    if (c != '\0' && (c < ' ' || c > '~')) c = '?';
  }
  report = read;
  return true;
}

void write_report(const BridgeReport& report, std::span<std::uint8_t> bytes) noexcept {
  std::memcpy(bytes.data(), &report, kReportBytes);
}

}  // namespace robot_control::unitree::go
