#pragma once
/// A Go1 for UnitreeDriver and UnitreeFront: all that differs between the robots.

#include <algorithm>
#include <numeric>

#include "drivers/unitree_legged/legged_messages.h"
#include "drivers/unitree_legged/unitree_legged_parameters.h"

namespace robot_control {

struct Go1 {
  using Line = UnitreeLeggedLine;
  using Command = unitree::LowCmd;
  using State = unitree::LowState;
  static constexpr std::size_t kCommandBytes = unitree::kCommandBytes, kStateBytes = unitree::kStateBytes;
  static constexpr std::size_t kFirstPosition = 76;  ///< byte of the position of the first motor
  static constexpr std::uint8_t kServo = unitree::kServo;
  static constexpr double kMaxTorque = unitree::kMaxTorque;
  static constexpr std::int64_t kTickNs = 1000;  ///< of the simulated robot
  static constexpr std::int64_t kPublishNs = 0;  ///< It answers each command, and sends nothing by itself.

  static constexpr const char *kName = "Go1", *kOtherLength = "length of its states, like an A1 or Aliengo";
  static constexpr const char* kNeverRight = "without exception: its firmware encrypts them, which is not supported";

  // The line ends in the robot: there is nothing between it and the driver.
  struct Notice {
    bool operator==(const Notice&) const = default;
  };
  struct Device {
    static constexpr std::size_t kHeadBytes = 0;
    static constexpr const char* kWords = "";
    static constexpr bool forwards = true;
    static bool write_head(std::span<std::uint8_t> /*head*/) noexcept { return true; }
    static bool inject(std::string_view /*component*/, std::string_view /*kind*/) { return false; }
  };
  explicit Go1(const Line& /*line*/) {}
  static std::span<const std::uint8_t> opened(std::span<const std::uint8_t> datagram,
                                              std::int64_t /*now_ns*/) noexcept {
    return datagram;
  }
  static LegObstacle obstacle(std::int64_t /*now_ns*/) noexcept { return {}; }
  static Notice notice() noexcept { return {}; }
  static std::string detail(DriveCause /*cause*/, const Notice& /*notice*/) { return ""; }
  static const char* remedy(DriveCause cause) {
    if (cause != DriveCause::kFirstFrame) return "";
    return "; put the robot into its low level with the remote: L2 and A, L2 and B, then L1, L2 and Start";
  }

  static auto decode(std::span<const std::uint8_t> bytes, auto& message) noexcept {
    return unitree::decode(bytes, message);
  }
  static auto encode(const auto& message, auto bytes) noexcept { return unitree::encode(message, bytes); }

  static double voltage(const State& state) noexcept {
    const auto& cells = state.battery.cells;
    return unitree::kCellVoltage * std::accumulate(cells.begin(), cells.end(), 0.0);
  }
  /// 23 V, of the simulated robot.
  static void set_voltage(State& state) noexcept { std::fill_n(state.battery.cells.begin(), 6, std::uint8_t{120}); }
};

using UnitreeLeggedJoint = UnitreeJoint<Go1>;
using UnitreeLeggedParameters = UnitreeParameters<Go1>;

}  // namespace robot_control
