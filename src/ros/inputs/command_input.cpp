#include "ros/inputs/command_input.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "ros/reports/name_list.h"
#include "signals/formatted_text.h"

namespace robot_control {
namespace {

constexpr std::size_t kMaxNames = MotionRequests::kMaxNames;

std::int64_t nanoseconds(double seconds) {
  return std::llround(1.0e9 * seconds);
}

std::string seconds(double value) {
  return formatted(std::abs(value) < 100 ? "%.3g s" : "%.0f s", value);
}

}  // namespace

CommandInput::CommandInput(double timeout, bool one_sender, std::string parameter)
    : one_sender_(one_sender), parameter_(std::move(parameter)) {
  set_timeout(timeout);
}

void CommandInput::set_timeout(double timeout) {
  timeout_ = timeout;
  timeout_ns_ = nanoseconds(timeout);
  set_silence(silence_needed(timeout));
}

void CommandInput::set_silence(double silence) {
  requests_.set_window(nanoseconds(silence));
}

std::vector<std::string> CommandInput::senders(std::int64_t loop_ns) {
  return requests_.senders(loop_ns, nanoseconds(std::max(timeout_, kSenderWindow)));
}

void CommandInput::receive(const ArrivedCommand& arrived, const ArrivalTime& time) {
  const JudgedStamp stamp = judge_stamp(arrived.stamp_ns, time.ros_ns, timeout_ns_);
  if (stamp.verdict != StampVerdict::kUsable) {
    ++value_.stale;
    requests_.request(arrived.sender, time.loop_ns);
    refuse_stamp(arrived.sender, stamp, time.loop_ns);
    return;
  }
  reported_stamps_.erase(arrived.sender.name);
  requests_.sent(arrived.sender, time.loop_ns);
  Request content{.twist = arrived.twist, .posture = arrived.posture, .mode = arrived.mode, .joints = arrived.joints};
  if (arrived.part == StatedPart::kTwist && !zero(content.twist)) content.mode = mode_;
  if (parts_of(content) == 0) {
    requests_.end(arrived.sender);
  } else {
    requests_.request(arrived.sender, time.loop_ns, arrived.stamp_ns == 0 ? 0 : time.ros_ns - arrived.stamp_ns);
  }
  update(time.loop_ns);
  if (value_.many_senders != 0) {
    ++value_.crowded;
    return;
  }
  if (requests_.revoked(arrived.sender)) {
    ++value_.revoked;
    return warn(
        "motion of " + arrived.sender.name +
            " is refused: it must send zero once after a stop, a restart or a pause. Publish zero from this node, or "
            "restart it",
        time.loop_ns);
  }
  accept(arrived, content, stamp.age_ns, time);
}

void CommandInput::accept(const ArrivedCommand& arrived, Request content, std::int64_t age_ns,
                          const ArrivalTime& time) {
  const std::string& topic = arrived.sender.topic;
  const bool own = same_process(sender_, arrived.sender);
  const bool beside_twist =
      arrived.part == StatedPart::kPose && !zero(value_.content.twist) && in_time(twist_ns_, time);
  if (!finite(content)) {
    if (own ? beside_twist : parts_of(value_.content) != 0) {
      ++value_.not_finite;
      if (own) end_pose(time);
    } else {
      set_command({}, arrived.sender, kNotFiniteMessage, time);
    }
    return warn(topic + " holds NaN or infinity: refused; check its sender " + arrived.sender.name, time.loop_ns);
  }
  if (beside_twist && !own) {
    ++value_.crowded;
    return warn(topic + " of " + arrived.sender.name + " is refused: the robot walks for " + sender_.name +
                    "; publish the pose from the sender of the twists",
                time.loop_ns);
  }
  const std::int64_t stated_ns = time.loop_ns - age_ns;
  const bool keeps_pose = own && arrived.part == StatedPart::kTwist && pose_ns_ && in_time(*pose_ns_, time);
  if (keeps_pose) {
    content.posture = value_.content.posture;
  } else {
    pose_ns_.reset();
  }
  if (arrived.part == StatedPart::kPose && content.posture != Posture{}) pose_ns_ = stated_ns;
  if (beside_twist) {
    content.twist = value_.content.twist;
    content.mode = value_.content.mode;
  } else {
    twist_ns_ = stated_ns;
  }
  age_ns = time.loop_ns - std::min(twist_ns_, pose_ns_.value_or(twist_ns_));
  set_command(content, arrived.sender, parts_of(content) == 0 && motion_requested(time.loop_ns) ? 1 : 0, time, age_ns);
}

/// Ends the pose of the command in force; its twist stays.
void CommandInput::end_pose(const ArrivalTime& time) {
  pose_ns_.reset();
  Request twist = value_.content;
  twist.posture = {};
  set_command(twist, sender_, 0, time, time.loop_ns - twist_ns_);
}

void CommandInput::receive_once(const Request& request, const ArrivalTime& time) {
  if (!requests_.granted()) return;
  pose_ns_.reset();
  twist_ns_ = time.loop_ns;
  set_command(request, {}, 0, time);
}

void CommandInput::set_command(const Request& content, const Publisher& sender, std::uint64_t contested,
                               const ArrivalTime& time, std::int64_t age_ns) {
  value_.content = content;
  value_.contested = contested;
  value_.age_ns = age_ns;
  sender_ = {sender.name, nullptr, sender.uri};
  command_ns_ = time.loop_ns;
  ++value_.count;
}

bool CommandInput::in_time(std::int64_t since_ns, const ArrivalTime& time) const {
  return timeout_ns_ <= 0 || time.loop_ns - since_ns <= timeout_ns_;
}

void CommandInput::withdraw(const Mode& mode, std::int64_t loop_ns) {
  if (value_.content.mode == mode) end_command(loop_ns);
}

bool CommandInput::update(std::int64_t loop_ns) {
  report_senders(loop_ns);
  const bool over = !requests_.granted() && parts_of(value_.content) != 0 && !motion_requested(loop_ns);
  if (over) end_command(loop_ns);
  const std::uint64_t many = one_sender_ && senders(loop_ns).size() > 1 && motion_requested(loop_ns) ? 1 : 0;
  return std::exchange(value_.many_senders, many) != many || over;
}

bool CommandInput::follow(const MotionPermission& permission, std::int64_t loop_ns) {
  if (!requests_.follow(permission, loop_ns)) return false;
  mode_ = {};
  if (parts_of(value_.content) != 0) end_command(loop_ns);
  return true;
}

void CommandInput::end_command(std::int64_t loop_ns) {
  value_.content = {};
  sender_ = {};
  value_.contested = std::abs(loop_ns - command_ns_) < unread_ns_ ? 1 : kNoMessage;
  ++value_.count;
}

std::vector<ReportLine> CommandInput::lines() {
  return std::exchange(lines_, {});
}

void CommandInput::warn(std::string text, std::int64_t loop_ns) {
  if (may_report(text, loop_ns)) lines_.push_back({true, std::move(text)});
}

void CommandInput::refuse_stamp(const Publisher& from, const JudgedStamp& stamp, std::int64_t loop_ns) {
  const std::string& sender = from.name;
  const bool too_old = stamp.verdict == StampVerdict::kTooOld;
  const auto reported = reported_stamps_.find(sender);
  if (reported != reported_stamps_.end() && reported->second == stamp.verdict) return;
  if (!may_report(sender + (too_old ? " behind" : " ahead"), loop_ns)) return;
  if (reported_stamps_.size() >= kMaxNames) reported_stamps_.clear();
  reported_stamps_[sender] = stamp.verdict;
  const double age = 1.0e-9 * static_cast<double>(stamp.age_ns);
  const std::string judged =
      too_old ? "is " + seconds(age) + " old by its stamp, more than " + parameter_ + " (" + seconds(timeout_) +
                    "): refused; it was delayed, or the clock of its sender is behind"
              : "is stamped " + seconds(-age) + " in the future, more than the allowed clock difference (" +
                    seconds(1.0e-9 * kClockSkew) +
                    "): refused; the clock of its sender is ahead, or is not the robot's /clock";
  lines_.push_back(
      {true, from.topic + " of " + sender + " " + judged +
                 "; synchronise it (chrony), or publish without a stamp: the age then counts from the arrival"});
}

void CommandInput::report_senders(std::int64_t loop_ns) {
  const std::vector<std::string> names = senders(loop_ns);
  if (names.size() < 2) {
    if (reported_senders_.empty()) return;
    lines_.push_back(
        {false, names.empty() ? "no node sends commands now" : "one sender of commands is left: " + names.front()});
    reported_senders_.clear();
    return;
  }
  if (std::ranges::includes(reported_senders_, names) || !may_report(joined(names), loop_ns)) return;
  const std::string consequence =
      one_sender_ ? "refused while one of them requests motion (one_sender), ramping down to standstill"
                  : "each message overrides the previous one (one_sender: true refuses them)";
  lines_.push_back(
      {true, std::to_string(names.size()) + " nodes send commands: " + joined(names) + "; " + consequence});
  reported_senders_ = names;
}

bool CommandInput::may_report(const std::string& what, std::int64_t loop_ns) {
  std::erase_if(reported_ns_, [&](const auto& entry) { return std::abs(loop_ns - entry.second) >= kRepeatAfter; });
  return reported_ns_.size() < kMaxNames && reported_ns_.emplace(what, loop_ns).second;
}

}  // namespace robot_control
