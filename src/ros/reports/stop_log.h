#pragma once
/// A StopLog writes the safety monitor's log: one line per event of SafetyStatus, so that no stop is silent.
///
///   a cause latches            WARN  state, cause, evidence and remedy; several at once: one line
///   a ramp has ended           INFO
///   a reset releases           INFO
///   INIT has ended             INFO  "ready: send cmd_vel", or what lets this kind of robot move
///   INIT waits for a zero      WARN  once, after a silence on cmd_vel would have ended INIT
///   a warning, no speed        WARN  each at most once in kRepeat s
///
/// Time is counted in cycles of the permits. The class is pure.

#include <robot_control/SafetyStatus.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "ros/reports/report_line.h"
#include "signals/robot_kinds.h"
#include "signals/velocity_command.h"

namespace robot_control {

class StopLog {
 public:
  static constexpr double kRepeat = 10;  ///< s
  /// s, added to the silence that counts as a zero request, until the log reports that INIT waits for a zero.
  static constexpr double kReserve = 0.25;
  static constexpr double kNoSpeed = 0.01;  ///< m/s; below this speed limit the robot cannot drive

  /// `period` is that of the loop in s. A silence on cmd_vel of `cmd_vel_timeout` [s] counts as a zero request.
  StopLog(double period, double cmd_vel_timeout, std::string_view kind = kWheeledKind)
      : period_(period), zero_silence_(silence_needed(cmd_vel_timeout)), begin_(names_of_kind(kind).begin) {}

  /// Returns the lines that are due at this status. Every published status is passed in the order of publication.
  std::vector<ReportLine> update(const SafetyStatus& status);

 private:
  void look_at_causes(const SafetyStatus& status, std::vector<ReportLine>& lines);
  void look_at_start(const SafetyStatus& status, std::vector<ReportLine>& lines);
  void look_at_warnings(const SafetyStatus& status, std::vector<ReportLine>& lines);
  bool due(const std::string& name, bool present, double now);

  double period_;        ///< s
  double zero_silence_;  ///< s
  std::string begin_;    ///< KindNames::begin
  std::set<std::string> latched_;
  bool stopping_ = false;
  bool starting_ = true;  ///< INIT since the last "ready"
  std::uint64_t run_ = 0;
  double awaiting_since_ = -1;  ///< s of this run; negative: INIT does not wait, or that was logged
  bool awaiting_ = false;
  std::set<std::string> present_;           ///< warnings in the last status
  std::map<std::string, double> reported_;  ///< time of the last line in s of this run, by warning
};

}  // namespace robot_control
