#pragma once
/// A Go2 or B2 for UnitreeDriver and UnitreeFront: all that differs between the robots. Between the driver and the
/// robot stands the program unitree_bridge, whose reports name further causes:
///
///   bridge           no datagram of it in max_silence: it ended, hangs, or was not started
///   motion service   it did not answer, or a mode is active: the driver waits, and the bridge sends no command
///   other device     another robot sends states on the same network: a driver that starts waits until it is gone, and the
///                    bridge sends no command before. It also waits while another one may not be seen yet
///   other commander  another program sent a command within the last second, or there are more than other_writers

#include "drivers/unitree_go/bridge_report.h"
#include "drivers/unitree_go/go_messages.h"
#include "drivers/unitree_go/unitree_go_parameters.h"

namespace robot_control {

class Go2 {
 public:
  using Line = UnitreeGoLine;
  using Command = unitree::go::LowCmd;
  using State = unitree::go::LowState;
  static constexpr std::size_t kCommandBytes = unitree::go::kCommandBytes, kStateBytes = unitree::go::kStateBytes;
  static constexpr std::size_t kFirstPosition = 84;  ///< byte of the position of the first motor
  static constexpr std::uint8_t kServo = unitree::go::kServo;
  static constexpr double kMaxTorque = unitree::go::kMaxTorque;
  static constexpr std::int64_t kTickNs = 1'000'000;
  static constexpr std::int64_t kPublishNs = 2'000'000;

  static constexpr const char *kName = "Go2", *kOtherLength = "length of its states",
                              *kNeverRight = "without exception";

  /// For words in other threads.
  struct Notice {
    std::uint32_t process = 0;
    decltype(unitree::go::BridgeReport::mode) mode{};
    bool operator==(const Notice&) const = default;
  };

  /// The bridge before a simulated robot. `inject` takes the component `bridge`.
  struct Device {
    static constexpr std::size_t kHeadBytes = unitree::go::kReportBytes;
    static constexpr const char* kWords =
        ", bridge (with ok, off, asked, active, no_answer, second_writer, other_commands, other_states)";
    bool forwards = true;  ///< commands

    /// Returns false if the bridge sends nothing.
    bool write_head(std::span<std::uint8_t> head) const noexcept;
    bool inject(std::string_view component, std::string_view kind);

    unitree::go::BridgeReport report{
        .process = 1, .robots = unitree::go::RobotsSeen::kOne, .service = unitree::go::MotionService::kFree};
    bool ended = false;
  };

  explicit Go2(const Line& line);

  /// Returns the state in a datagram of the bridge; nothing if it has none. A state without a report is none.
  std::span<const std::uint8_t> opened(std::span<const std::uint8_t> datagram, std::int64_t now_ns) noexcept;
  LegObstacle obstacle(std::int64_t now_ns) const noexcept;
  Notice notice() const noexcept { return {.process = report_.process, .mode = report_.mode}; }

  // An ordinary thread calls these two, which add to the words of a status.
  static std::string detail(DriveCause cause, const Notice& notice);
  static const char* remedy(DriveCause cause);

  static unitree::Flaw decode(std::span<const std::uint8_t> bytes, State& state) noexcept;
  static unitree::Flaw decode(std::span<const std::uint8_t> bytes, Command& command) noexcept {
    return unitree::go::decode(bytes, command);
  }
  static bool encode(const auto& message, auto bytes) noexcept { return unitree::go::encode(message, bytes); }

  static double voltage(const State& state) noexcept { return double{state.voltage}; }
  static void set_voltage(State& state) noexcept { state.voltage = 28.8F; }

 private:
  std::int64_t max_silence_ns_;
  std::uint64_t other_writers_;
  unitree::go::BridgeReport report_;
  std::int64_t report_ns_ = 0;  // of any datagram
  bool has_report_ = false;
};

}  // namespace robot_control
