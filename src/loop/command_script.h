#pragma once
/// Messages written down beforehand: a deterministic entrance beside `cmd_vel` and the e-stop services.
///
///   cycle,linear,angular,event
///   0,0.5,0.2,
///   1000,nan,0,
///   1500,,,e_stop
///   3000,0,0,e_stop_reset
///
/// A row is a message received in that cycle. Speeds are m/s and rad/s as on `cmd_vel`, and subject to its timeout. The
/// events are calls of the services `e_stop_trigger` and `e_stop_reset`. The header line is required, its last column
/// may be left out. A row with an event may leave both speeds empty. NaN and infinity are passed on: a bad message is a
/// legitimate test, and the controller refuses it. A speed that the robot would ignore is refused when the script is
/// read. Blank lines and lines that begin with # are skipped. Cycles may repeat, not decrease.
///
/// A script begins each run with a request of zero velocity before its first row. So the first row may move the robot
/// (safety/latch/motion_release.h).

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "signals/velocity_command.h"

namespace robot_control {

/// The messages received since the last call of `advance`.
struct ScriptEvents {
  bool has_twist = false;
  Twist twist;               ///< the last one received
  std::uint64_t twists = 0;  ///< how many there were
  std::uint64_t e_stops = 0;
  std::uint64_t resets = 0;
};

class CommandScript {
 public:
  /// A script without events.
  CommandScript() = default;

  /// Reads a CSV file; throws ParameterError with every bad line (line, column, value, rule). `executable`: RequestPart
  /// bits that the robot executes.
  explicit CommandScript(const std::string& path, std::uint64_t executable = kEveryPart);

  /// The same from text; `source` stands in messages.
  static CommandScript parse(std::string_view text, const std::string& source, std::uint64_t executable = kEveryPart);

  /// The rows behind the last call up to and with `cycle`: those of skipped cycles arrive late, none is lost.
  /// A cycle at or before that of the last call brings nothing new.
  ScriptEvents advance(std::uint64_t cycle) noexcept;

  /// A new run: from the first row again.
  void rewind() noexcept { next_ = 0; }

  /// Each run then begins with a zero request, as every script that was read does.
  void begin_with_zero() noexcept { begins_with_zero_ = true; }
  bool begins_with_zero() const noexcept { return begins_with_zero_; }

  std::size_t size() const noexcept { return rows_.size(); }

  static constexpr std::uint64_t kEveryPart = ~std::uint64_t{0};

 private:
  enum class Event { kNone, kEmergencyStop, kReset };
  struct Row {
    std::uint64_t cycle = 0;
    std::optional<Twist> twist;
    Event event = Event::kNone;
  };
  class Parser;

  std::vector<Row> rows_;
  std::size_t next_ = 0;
  bool begins_with_zero_ = false;
};

/// The script of the parameter `command_script`: where that is empty, one without events.
inline CommandScript load_script(const std::string& path, std::uint64_t executable = CommandScript::kEveryPart) {
  return path.empty() ? CommandScript() : CommandScript(path, executable);
}

}  // namespace robot_control
