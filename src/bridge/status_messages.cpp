#include "bridge/status_messages.h"

#include <span>

#include "signals/names.h"

namespace robot_control {
namespace {

/// "sentence (remedy)" per bit set.
std::vector<std::string> sentences(std::span<const BitName> table, std::uint64_t bits) {
  std::vector<std::string> texts;
  for (const BitName& row : table) {
    if ((bits & row.bit) != 0) texts.push_back(sentences_of({&row, 1}, row.bit));
  }
  return texts;
}

/// A message's vector has its own allocator.
template <class Strings>
void assign(Strings& to, const std::vector<std::string>& from) {
  to.assign(from.begin(), from.end());
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

msg::SafetyStatus safety_status(const Permit& permit, const std::vector<std::string>& absent, const TimeMap& time,
                                std::int64_t period_ns) {
  msg::SafetyStatus message;
  message.header.stamp = time.at(permit.head.stamp_ns);
  message.state = static_cast<std::uint8_t>(permit.state);
  message.state_name = name_of(permit.state);
  message.permit = static_cast<std::uint8_t>(permit.action);
  message.permit_name = name_of(permit.action);
  const auto cycles = static_cast<std::int64_t>(permit.head.cycle - permit.since_cycle);
  message.since = time.at(permit.head.stamp_ns - cycles * period_ns);
  for (const BitName& row : kStopCauseNames) {
    if ((permit.active & row.bit) != 0) message.active.emplace_back(row.name);
    if ((permit.causes & row.bit) == 0) continue;
    message.causes.emplace_back(row.name);
    message.sentences.emplace_back(row.sentence);
    message.remedies.emplace_back(row.remedy);
  }
  message.first_cause = names_of(kStopCauseNames, permit.first_cause);
  assign(message.missing, absent);
  if (absent.empty() && permit.state == SupervisorState::kInit) {
    assign(message.missing, sentences(kMissingNodeNames, permit.missing));
  }
  message.resets = permit.resets_handled;
  assign(message.reset_refusal, sentences(kResetRefusalNames, permit.reset_refusal));
  message.run = permit.head.run;
  message.cycle = permit.head.cycle;
  return message;
}

msg::SafetyStatus waiting_status(const std::vector<std::string>& missing) {
  msg::SafetyStatus message;
  message.state = msg::SafetyStatus::INIT;
  message.state_name = name_of(SupervisorState::kInit);
  message.permit = msg::SafetyStatus::PERMIT_BRAKE;
  message.permit_name = name_of(PermitAction::kBrake);
  assign(message.missing, missing);
  return message;
}

bool news(const Permit& last, const Permit& now) {
  return last.state != now.state || last.action != now.action || last.causes != now.causes ||
         last.active != now.active || last.first_cause != now.first_cause || last.missing != now.missing ||
         last.resets_handled != now.resets_handled || last.reset_refusal != now.reset_refusal ||
         last.head.run != now.head.run;
}

std::string reset_text(const Permit& before, const Permit& permit, const std::vector<std::string>& senders) {
  if (permit.reset_refusal == 0) return before.causes == 0 ? "nothing was stopped" : "released";
  std::string text = "refused: " + sentences_of(kResetRefusalNames, permit.reset_refusal);
  if ((permit.reset_refusal & kRefusalCauseActive) != 0) {
    text += "; persists: " + sentences_of(kStopCauseNames, permit.active);
  }
  if ((permit.reset_refusal & kRefusalCommand) != 0 && !senders.empty()) {
    text += "; publishing on cmd_vel: " + joined(senders);
  }
  if ((permit.reset_refusal & kRefusalInit) != 0) {
    text += "; waiting: " + sentences_of(kMissingNodeNames, permit.missing);
  }
  return text;
}

}  // namespace robot_control
