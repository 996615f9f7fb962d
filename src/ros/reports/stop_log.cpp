#include "ros/reports/stop_log.h"

#include <algorithm>
#include <limits>

#include "signals/formatted_text.h"
#include "signals/names.h"

namespace robot_control {
namespace {

bool may_drive(const SafetyStatus& status) {
  return status.state == SafetyStatus::READY || status.state == SafetyStatus::DRIVE;
}

/// Returns "stall: a wheel does not turn although … (0.6 rad, limit 0.5 rad, left_wheel_joint)".
std::string cause_text(const SafetyStatus& status, std::size_t i) {
  std::string text = status.causes[i] + ": " + status.sentences[i];
  if (!status.details[i].empty()) text += " (" + status.details[i] + ")";
  return text;
}

/// Some warnings are of the machine or its files. Those of conditions limit the speed.
bool limits_speed(const std::string& warning) {
  return std::ranges::any_of(kStopCauseNames, [&](const BitName& row) { return row.name == warning; });
}

}  // namespace

std::vector<ReportLine> StopLog::update(const SafetyStatus& status) {
  if (status.run != run_) {
    run_ = status.run;
    awaiting_ = false;
    reported_.clear();
  }
  std::vector<ReportLine> lines;
  look_at_causes(status, lines);
  look_at_start(status, lines);
  look_at_warnings(status, lines);
  return lines;
}

void StopLog::look_at_causes(const SafetyStatus& status, std::vector<ReportLine>& lines) {
  std::string causes;
  std::string remedies;
  for (std::size_t i = 0; i < status.causes.size(); ++i) {
    if (!latched_.insert(status.causes[i]).second) continue;
    const std::string text = cause_text(status, i);
    const bool first = status.causes[i] == status.first_cause;
    causes = causes.empty() ? text : first ? text + "; " + causes : causes + "; " + text;
    const std::string& remedy = status.remedies_before_reset[i];
    if (remedies.find(remedy) == std::string::npos) remedies += (remedies.empty() ? "" : "; ") + remedy;
  }
  const bool stopping = status.state == SafetyStatus::STOPPING;
  if (!causes.empty()) {
    lines.push_back({true, status.state_name + ": " + causes + ". To drive again: " + remedies +
                               (remedies.empty() ? "" : ", then ") + "call e_stop_reset"});
  } else if (stopping_ && status.state == SafetyStatus::STOPPED) {
    lines.push_back({false, "STOPPED: the ramp has ended, the robot brakes"});
  }
  stopping_ = stopping;
  // A status without a permit has no causes, which does not mean that the stop was released.
  if (!latched_.empty() && status.causes.empty() && may_drive(status)) {
    latched_.clear();
    starting_ = false;
    lines.push_back({false, "released: " + status.state_name + "; " + begin_});
  }
}

void StopLog::look_at_start(const SafetyStatus& status, std::vector<ReportLine>& lines) {
  const double now = static_cast<double>(status.cycle) * period_;
  if (may_drive(status)) {
    if (starting_) lines.push_back({false, "ready: " + begin_});
    starting_ = false;
  }
  if (status.state == SafetyStatus::INIT) starting_ = true;
  const bool awaiting = status.awaiting_zero_request != 0;
  if (awaiting && !awaiting_) awaiting_since_ = now;
  awaiting_ = awaiting;
  if (!awaiting || awaiting_since_ < 0 || now - awaiting_since_ < zero_silence_ + kReserve) return;
  awaiting_since_ = -1;
  lines.push_back({true, formatted("%s: waiting for a zero velocity command; stop publishing for %g s, or publish zero",
                                   status.state_name.c_str(), zero_silence_)});
}

bool StopLog::due(const std::string& name, bool present, double now) {
  const bool before = present_.contains(name);
  if (!present) {
    present_.erase(name);
    return false;
  }
  present_.insert(name);
  if (before || (reported_.contains(name) && now - reported_[name] < kRepeat)) return false;
  reported_[name] = now;
  return true;
}

void StopLog::look_at_warnings(const SafetyStatus& status, std::vector<ReportLine>& lines) {
  const double now = static_cast<double>(status.cycle) * period_;
  for (auto i = present_.begin(); i != present_.end();) {
    const bool stays = *i == "clearance" || std::ranges::find(status.warnings, *i) != status.warnings.end();
    i = stays ? std::next(i) : present_.erase(i);
  }
  for (std::size_t i = 0; i < status.warnings.size(); ++i) {
    if (!due(status.warnings[i], true, now)) continue;
    std::string text = "warning: " + status.warnings[i] + ": " + status.warning_sentences[i];
    if (limits_speed(status.warnings[i]) && status.speed_limit < std::numeric_limits<double>::infinity()) {
      text += "; at most " + formatted("%.3g m/s", status.speed_limit);
    }
    lines.push_back({true, text});
  }
  const bool no_speed = std::ranges::none_of(status.warnings, limits_speed) && status.speed_limit < kNoSpeed;
  if (due("clearance", no_speed, now)) {
    lines.push_back({true, "blocked: the free distance (clearance) is 0"});
  }
}

}  // namespace robot_control
