#include "ros/messages/status_messages.h"

#include <algorithm>
#include <limits>
#include <span>
#include <string_view>

#include "files/ascii.h"
#include "machine/fault_names.h"
#include "ros/reports/name_list.h"
#include "signals/formatted_text.h"
#include "signals/names.h"

namespace robot_control {
namespace {

/// Returns "sentence (remedy)" for each bit that is set.
std::vector<std::string> sentences(std::span<const BitName> table, std::uint64_t bits, const Programs& programs) {
  std::vector<std::string> texts;
  for (const BitName& row : table) {
    if ((bits & row.bit) != 0) texts.push_back(sentences_of({&row, 1}, row.bit, programs));
  }
  return texts;
}

/// Returns "17.3 rad/s".
std::string quantity(double value, std::string_view unit) {
  return formatted("%.4g ", value).append(unit);
}

/// Returns "charge the battery, then call e_stop_reset".
std::string with_reset(std::string_view remedy, const Programs& programs) {
  return with_programs(remedy, programs).append(remedy.empty() ? "" : ", then ").append("call e_stop_reset");
}

/// Returns "the battery is low: 20.9 V, limit 21 V (charge the battery soon)".
std::string warning_sentence(const BitName& row, const std::string& measured, const Programs& programs) {
  std::string text = with_programs(row.sentence, programs);
  if (!measured.empty()) text.append(": ").append(measured);
  if (!row.remedy.empty()) text.append(" (").append(with_programs(row.remedy, programs)).append(")");
  return text;
}

}  // namespace

std::string detail(const Permit& permit, std::uint64_t cause, const MachineModel& robot) {
  const auto* evidence = std::ranges::find(permit.evidence, cause, &CauseEvidence::cause);
  const BitName* row = row_of(kStopCauseNames, cause);
  if (evidence == permit.evidence.end() || row == nullptr) return {};
  std::string text;
  if (!row->unit.empty()) {
    text = quantity(evidence->value, row->unit) + ", limit " + quantity(evidence->limit, row->unit);
  }
  if (evidence->joint < robot.joints.size()) {
    text.append(text.empty() ? "" : ", ").append(robot.joints[evidence->joint].name);
  }
  return ascii(text);
}

RobotKind robot_kind(const MachineModel& robot, const Programs& programs, bool injects) {
  RobotKind message;
  message.robot = ascii(robot.name);
  message.kind = programs.kind;
  for (const Role role : {Role::kDriver, Role::kEstimator, Role::kController, Role::kMonitor}) {
    message.roles.emplace_back(kRoles[static_cast<std::size_t>(role)].role);
    message.nodes.emplace_back(program_of(role, programs));
  }
  for (const JointModel& joint : robot.joints) {
    message.joints.push_back(ascii(joint.name));
    message.joint_roles.emplace_back(name_of(joint.role));
  }
  if (!injects) return message;
  for (const std::string& word : fault_words(robot)) message.fault_components.push_back(ascii(word));
  for (const std::string_view fault : kFaultKindNames) message.fault_kinds.emplace_back(fault);
  return message;
}

SafetyStatus safety_status(const Permit& permit, const MachineModel& robot, const std::vector<std::string>& absent,
                           const TimeMap& time, std::int64_t period_ns, const Programs& programs) {
  SafetyStatus message;
  message.header.stamp = time.at(permit.head.stamp_ns);
  message.state = static_cast<std::uint8_t>(permit.state);
  message.state_name = name_of(permit.state);
  message.permit = static_cast<std::uint8_t>(permit.action);
  message.permit_name = name_of(permit.action);
  const auto cycles = static_cast<std::int64_t>(permit.head.cycle - permit.since_cycle);
  message.since = time.at(permit.head.stamp_ns - cycles * period_ns);
  for (const BitName& row : kStopCauseNames) {
    if ((permit.active & row.bit) != 0) message.active.emplace_back(row.name);
    if ((permit.warnings & row.bit) != 0) {
      message.warnings.emplace_back(row.name);
      message.warning_sentences.push_back(warning_sentence(row, detail(permit, row.bit, robot), programs));
    }
    if ((permit.causes & row.bit) == 0) continue;
    message.causes.emplace_back(row.name);
    message.sentences.push_back(with_programs(row.sentence, programs));
    message.remedies.push_back(with_reset(row.remedy, programs));
    message.remedies_before_reset.push_back(with_programs(row.remedy, programs));
    message.actors.emplace_back(row.actor);
    message.details.push_back(detail(permit, row.bit, robot));
  }
  message.speed_limit =
      permit.speed_limit < kNoSpeedLimit ? permit.speed_limit : std::numeric_limits<double>::infinity();
  message.first_cause = names_of(kStopCauseNames, permit.first_cause);
  message.missing = absent;
  if (absent.empty() && permit.state == SupervisorState::kInit) {
    message.missing = sentences(kMissingNodeNames, permit.missing, programs);
  }
  message.awaiting_zero_request =
      permit.state == SupervisorState::kInit && permit.missing == 0 && permit.unreleased != 0 && absent.empty();
  message.resets = permit.resets_handled;
  message.withdrawals = permit.withdrawals;
  message.reset_refusal = sentences(kResetRefusalNames, permit.reset_refusal, programs);
  message.run = permit.head.run;
  message.cycle = permit.head.cycle;
  return message;
}

void warn_of_blind_conditions(const SensorFrame& sensors, SafetyStatus& status) {
  const bool blind = std::any_of(
      sensors.joints.begin(), sensors.joints.begin() + std::min<std::size_t>(sensors.joint_count, kMaxJoints),
      [](const JointSample& joint) { return (joint.valid & kValidMotion) == kValidKinematics; });
  if (!blind) return;
  status.warnings.emplace_back("torque_not_measured");
  status.warning_sentences.emplace_back(
      "the drives measure no torque: wheel_effort, power and torque_oscillation detect nothing, and stall uses speeds "
      "only "
      "(the limits of the drives protect motor and gear)");
}

SafetyStatus waiting_status(const std::vector<std::string>& missing) {
  SafetyStatus message;
  message.state = SafetyStatus::INIT;
  message.state_name = name_of(SupervisorState::kInit);
  message.permit = SafetyStatus::PERMIT_BRAKE;
  message.permit_name = name_of(PermitAction::kBrake);
  message.speed_limit = std::numeric_limits<double>::infinity();
  message.missing = missing;
  return message;
}

bool differs(const Permit& last, const Permit& now) {
  return last.state != now.state || last.action != now.action || last.causes != now.causes ||
         last.active != now.active || last.warnings != now.warnings || last.speed_limit != now.speed_limit ||
         last.first_cause != now.first_cause || last.missing != now.missing || last.unreleased != now.unreleased ||
         last.withdrawals != now.withdrawals || last.resets_handled != now.resets_handled ||
         last.reset_refusal != now.reset_refusal || last.head.run != now.head.run;
}

std::string reset_text(const Permit& before, const Permit& permit, const Publishers& publishers,
                       const Programs& programs) {
  if (permit.reset_refusal == 0) return before.causes == 0 ? "nothing was stopped" : "released";
  std::string text = "refused: " + sentences_of(kResetRefusalNames, permit.reset_refusal, programs);
  if ((permit.reset_refusal & kRefusalCauseActive) != 0) {
    text += "; persists: " + sentences_of(kStopCauseNames, permit.active, programs);
    if (!publishers.e_stop.empty()) text += "; true on e_stop: " + joined(publishers.e_stop);
  }
  if ((permit.reset_refusal & kRefusalCommand) != 0 && !publishers.commands.empty()) {
    text += "; publishing on " + std::string(names_of_kind(programs.kind).request) + ": " + joined(publishers.commands);
  }
  if ((permit.reset_refusal & kRefusalInit) != 0) {
    text += "; waiting: " + sentences_of(kMissingNodeNames, permit.missing, programs);
  }
  return text;
}

}  // namespace robot_control
