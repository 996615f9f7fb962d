#include "ros/inputs/command_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "ros/reports/name_list.h"

namespace robot_control {
namespace {

constexpr std::size_t kMaxNames = 16;  // names stored at most, as in CommandSenders

std::int64_t nanoseconds(double seconds) {
  return std::llround(1.0e9 * seconds);
}

std::string seconds(double value) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), std::abs(value) < 100 ? "%.3g s" : "%.0f s", value);
  return text.data();
}

}  // namespace

CommandInput::CommandInput(double timeout, bool one_sender, CommandWords words)
    : one_sender_(one_sender), words_(std::move(words)) {
  set_timeout(timeout);
}

void CommandInput::set_timeout(double timeout) {
  timeout_ = timeout;
  timeout_ns_ = nanoseconds(timeout);
  senders_.set_window(nanoseconds(std::max(timeout, kSenderWindow)));
  set_silence(silence_needed(timeout));
}

void CommandInput::set_silence(double silence) {
  requests_.set_window(nanoseconds(silence));
}

void CommandInput::receive(const ArrivedCommand& arrived, const ArrivalTime& time) {
  const JudgedStamp stamp = judge_stamp(arrived.stamp_ns, time.ros_ns, timeout_ns_);
  if (stamp.verdict != StampVerdict::kUsable) {
    ++value_.stale;
    requests_.request(arrived.sender, time.loop_ns);
    refuse_stamp(arrived.sender.name, stamp, time.loop_ns);
    return;
  }
  reported_stamps_.erase(arrived.sender.name);
  senders_.add(arrived.sender.name, time.loop_ns);
  update(time.loop_ns);
  if (value_.many_senders != 0) {
    ++value_.crowded;
    requests_.request(arrived.sender, time.loop_ns);
    return;
  }
  const Request content{
      .twist = arrived.twist, .posture = arrived.posture, .mode = arrived.mode, .joints = arrived.joints};
  const bool zero = parts_of(content) == 0;
  if (zero) {
    requests_.end(arrived.sender);
  } else {
    requests_.request(arrived.sender, time.loop_ns, arrived.stamp_ns == 0 ? 0 : time.ros_ns - arrived.stamp_ns);
  }
  if (requests_.revoked(arrived.sender)) {
    ++value_.revoked;
    refuse_revoked(arrived.sender.name, time.loop_ns);
    return;
  }
  value_.contested = zero && motion_requested(time.loop_ns) ? 1 : 0;
  value_.content = content;
  value_.age_ns = stamp.age_ns;
  command_ns_ = time.loop_ns;
  ++value_.count;
}

void CommandInput::receive_once(const Request& request, const ArrivalTime& time) {
  value_.content = request;
  value_.contested = 0;
  value_.age_ns = 0;
  command_ns_ = time.loop_ns;
  ++value_.count;
}

void CommandInput::withdraw(std::uint64_t mode, std::int64_t loop_ns) {
  if (value_.content.mode == mode) end_command(loop_ns);
}

bool CommandInput::update(std::int64_t loop_ns) {
  report_senders(loop_ns);
  const bool over = !requests_.granted() && parts_of(value_.content) != 0 && !motion_requested(loop_ns);
  if (over) end_command(loop_ns);
  const std::uint64_t many = one_sender_ && senders_.count(loop_ns) > 1 ? 1 : 0;
  return std::exchange(value_.many_senders, many) != many || over;
}

bool CommandInput::follow(const MotionPermission& permission, std::int64_t loop_ns) {
  if (!requests_.follow(permission, loop_ns)) return false;
  if (parts_of(value_.content) != 0) end_command(loop_ns);
  return true;
}

void CommandInput::end_command(std::int64_t loop_ns) {
  value_.content = {};
  value_.contested = std::abs(loop_ns - command_ns_) < unread_ns_ ? 1 : kNoMessage;
  ++value_.count;
}

std::vector<ReportLine> CommandInput::lines() {
  return std::exchange(lines_, {});
}

void CommandInput::refuse_revoked(const std::string& sender, std::int64_t loop_ns) {
  if (!may_report(sender + " revoked", loop_ns)) return;
  lines_.push_back({true, "motion of " + sender +
                              " is refused: it was requested before a stop, a restart or a pause ended the permission "
                              "to move, or meanwhile, or may have been; let that sender send zero, or restart it"});
}

void CommandInput::refuse_stamp(const std::string& sender, const JudgedStamp& stamp, std::int64_t loop_ns) {
  const bool too_old = stamp.verdict == StampVerdict::kTooOld;
  const auto reported = reported_stamps_.find(sender);
  if (reported != reported_stamps_.end() && reported->second == stamp.verdict) return;
  if (!may_report(sender + (too_old ? " behind" : " ahead"), loop_ns)) return;
  if (reported_stamps_.size() >= kMaxNames) reported_stamps_.clear();
  reported_stamps_[sender] = stamp.verdict;
  const double age = 1.0e-9 * static_cast<double>(stamp.age_ns);
  const std::string remedy =
      "; synchronise it (chrony), or let it send without a stamp: the age then counts from the arrival";
  if (too_old) {
    lines_.push_back({true, words_.stamped + " of " + sender + " is " + seconds(age) + " old by its stamp, more than " +
                                words_.timeout + " (" + seconds(timeout_) +
                                "): refused; it was long under way, or that sender's clock is behind" + remedy});
  } else {
    lines_.push_back({true, words_.stamped + " of " + sender + " is stamped " + seconds(-age) +
                                " in the future, more than clocks may differ (" + seconds(1.0e-9 * kClockSkew) +
                                "): refused; that sender's clock is ahead, or is not the robot's /clock" + remedy});
  }
}

void CommandInput::report_senders(std::int64_t loop_ns) {
  const std::vector<std::string> names = senders_.at(loop_ns);
  if (names.size() < 2) {
    if (reported_senders_.empty()) return;
    lines_.push_back({false, names.empty() ? "no node sends commands any more"
                                           : "one sender of commands is left: " + names.front()});
    reported_senders_.clear();
    return;
  }
  if (std::ranges::includes(reported_senders_, names) || !may_report(joined(names), loop_ns)) return;
  const std::string consequence = one_sender_ ? "refused (one_sender), ramping down to standstill until one is left"
                                              : "each message overrides the one before (one_sender: true refuses them)";
  lines_.push_back(
      {true, std::to_string(names.size()) + " nodes send commands: " + joined(names) + "; " + consequence});
  reported_senders_ = names;
}

bool CommandInput::may_report(const std::string& what, std::int64_t loop_ns) {
  std::erase_if(reported_ns_, [&](const auto& entry) { return std::abs(loop_ns - entry.second) >= kRepeatAfter; });
  return reported_ns_.size() < kMaxNames && reported_ns_.emplace(what, loop_ns).second;
}

}  // namespace robot_control
