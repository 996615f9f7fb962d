#pragma once
/// CommandReport writes the controller's log lines about received commands and their effect. It is pure.
///
///   normal driving        the wheel speeds that result, after the speed limits if these apply
///   brake or ramp         the command has no effect, with the reason
///   slowed down           the safety monitor limits the speed, and where its reason is shown
///   warning               a timeout that stopped a motion
///
/// A line is written when one of these changes; wheel speeds have to change by kSpeedStep or more. Lines of one kind
/// are at least kGap apart, and a change within the gap is reported after it. A new effect is reported after it has
/// lasted for kSettle, so that a single late cycle is not reported. CommandInput reports messages that are refused.
/// Time is that of the frames.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/wheeled/drive_controller.h"
#include "control/wheeled/kinematics.h"
#include "control/wheeled/limits/speed_limiter.h"
#include "machine/wheeled/drive_train.h"
#include "ros/reports/report_line.h"
#include "signals/command_frame.h"

namespace robot_control {

class CommandReport {
 public:
  static constexpr std::int64_t kGap = 1'000'000'000;   ///< ns
  static constexpr std::int64_t kSettle = 100'000'000;  ///< ns
  static constexpr double kSpeedStep = 0.01;            ///< m/s

  CommandReport(const DriveTrain& robot, const DriveControllerParameters& parameters);

  /// Applies other limits and another timeout from now on.
  void limit(const DriveControllerParameters& parameters);

  /// Returns the lines that are due at this frame. Any number of cycles may lie between two frames.
  std::vector<ReportLine> update(const CommandFrame& command);

 private:
  /// The content of a line about a command.
  struct Report {
    SidePair rims;  ///< m/s, after the speed limits
    bool zero = true;
    bool limited = false;
    std::uint64_t hindrance = 0;  ///< CommandReason bits
  };

  /// The time since the last line of one kind.
  class Gap {
   public:
    bool over(std::int64_t now_ns) const { return !last_ns_ || now_ns - *last_ns_ >= kGap; }
    void begin(std::int64_t now_ns) { last_ns_ = now_ns; }

   private:
    std::optional<std::int64_t> last_ns_;
  };

  void enter_run(const CommandFrame& command);
  Report made_of(const CommandFrame& command) const;
  std::string text(const Report& report, const CommandFrame& command) const;
  static bool same(const Report& one, const Report& other);

  DriveKinematics kinematics_;
  SpeedLimits limits_;
  double timeout_;  ///< s
  std::uint64_t run_ = 0;
  std::uint64_t timeouts_ = 0;
  std::optional<Report> reported_;  ///< last line about the present motion
  std::uint64_t hindrance_ = 0;     ///< CommandReason bits of the last frame
  std::int64_t hindered_since_ns_ = 0;
  Gap line_gap_;
  Gap timeout_gap_;
};

}  // namespace robot_control
