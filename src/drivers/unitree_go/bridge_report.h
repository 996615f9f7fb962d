#pragma once
/// A BridgeReport is what the program unitree_bridge knows and the robot's states do not say. It stands before the
/// bytes of a LowState in each datagram to the driver. Without a state the bridge sends the report alone, kReportNs
/// after its last datagram. So the driver distinguishes a silent robot from a lost bridge.
///
/// A datagram to the bridge is a LowCmd without more.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robot_control::unitree::go {

/// The maker's own controller, which commands the same motors.
enum class MotionService : std::uint8_t {
  kAsked,     ///< It has not answered yet.
  kFree,      ///< It answered that no mode is active.
  kActive,    ///< A mode is active; `mode` names it.
  kNoAnswer,  ///< It does not answer.
  kNone,      ///< The drive file states that there is none.
};

/// The robots that send states on the network.
enum class RobotsSeen : std::uint8_t {
  kNone,
  kAwaited,  ///< One does, and another one may not be seen yet.
  kOne,
  kMore,  ///< Another one sent a state within the last second.
};

struct BridgeReport {
  static constexpr std::uint32_t kMagic = 0x32424755;  // "UGB2"

  std::uint32_t magic = kMagic;
  std::uint32_t process = 0;        ///< id of the bridge's process
  std::uint16_t writers = 0;        ///< other DDS writers of rt/lowcmd
  std::uint8_t other_commands = 0;  ///< 1: one of them sent a command within the last second
  RobotsSeen robots = RobotsSeen::kNone;
  MotionService service = MotionService::kAsked;
  std::array<char, 15> mode{};  ///< of the motion service, ends with 0

  bool operator==(const BridgeReport&) const = default;
};

inline constexpr std::size_t kReportBytes = sizeof(BridgeReport);
static_assert(kReportBytes == 28);
inline constexpr std::int64_t kReportNs = 2'000'000;

/// Returns whether the bytes begin with a report; if not, `report` does not change.
bool read_report(std::span<const std::uint8_t> bytes, BridgeReport& report) noexcept;
void write_report(const BridgeReport& report, std::span<std::uint8_t> bytes) noexcept;

}  // namespace robot_control::unitree::go
