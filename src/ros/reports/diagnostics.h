#pragma once
/// A DiagnosticReport is one node's entry on /diagnostics (REP 107): worst level, one sentence, named values.

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "machine/machine_model.h"
#include "signals/command_frame.h"
#include "signals/names.h"
#include "signals/permit.h"
#include "signals/robot_kinds.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class DiagnosticReport {
 public:
  DiagnosticReport(const std::string& node, const std::string& hardware);

  void ok(const std::string& sentence) { raise(diagnostic_msgs::DiagnosticStatus::OK, sentence); }
  void warn(const std::string& sentence) { raise(diagnostic_msgs::DiagnosticStatus::WARN, sentence); }
  void error(const std::string& sentence) { raise(diagnostic_msgs::DiagnosticStatus::ERROR, sentence); }
  void value(const std::string& key, const std::string& text);
  void value(const std::string& key, double number);
  void value(const std::string& key, std::uint64_t number) { value(key, std::to_string(number)); }

  /// Adds one value per bit that is set: "gate: command_held" = "the command is older than one cycle and is held".
  void reasons(const std::string& subject, std::span<const BitName> table, std::uint64_t bits,
               const Programs& programs);

  const diagnostic_msgs::DiagnosticStatus& message() const noexcept { return message_; }

 private:
  void raise(diagnostic_msgs::DiagnosticStatus::_level_type level, const std::string& sentence);

  diagnostic_msgs::DiagnosticStatus message_;
};

/// Adds a warning with the names of missing nodes.
void report_missing(DiagnosticReport& report, const std::vector<std::string>& missing);

void report_driver(DiagnosticReport& report, const SensorFrame& sensors, const MachineModel& machine,
                   const Programs& programs, double real_time_factor);
/// `slip_lately` has the SlipReason bits of all cycles since the last report.
/// Calibration, confidences and wheel slip are those of a robot on wheels.
void report_state(DiagnosticReport& report, const StateFrame& state, std::uint64_t slip_lately,
                  const Programs& programs);
/// `lately` has the CommandReason bits of all cycles since the last report; `senders` names the senders of commands.
/// Several senders are a fault unless they send to different `sources` (CommandMux::states; empty: there is no list).
/// `revoked` is CommandIntake::revoked.
void report_command(DiagnosticReport& report, const CommandFrame& command, std::uint64_t lately,
                    const Programs& programs, const std::vector<std::string>& senders,
                    const std::vector<std::string>& sources = {}, const std::vector<std::string>& revoked = {});
void report_permit(DiagnosticReport& report, const Permit& permit, const Programs& programs);

}  // namespace robot_control
