#include "ros/inputs/command_mux.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace robot_control {
namespace {

/// Returns whether a message is not older than `timeout`. A time that went back by more than that (a new simulation)
/// makes it old.
bool recent(const std::optional<std::int64_t>& last_ns, double timeout, std::int64_t now_ns) {
  if (!last_ns) return false;
  return timeout == 0 || std::abs(now_ns - *last_ns) <= std::llround(1.0e9 * timeout);
}

}  // namespace

CommandMux::CommandMux(const CommandSourceList& list, double timeout, bool one_sender) {
  for (const CommandSource& source : list.sources) {
    sources_.push_back({.given = source, .input = CommandInput(source.timeout, one_sender), .last_ns = {}, .lock = {}});
  }
  for (const CommandLock& lock : list.locks) {
    locks_.push_back({.given = lock, .last_ns = {}, .set = false, .locks = false});
  }
  CommandMux::set_timeout(timeout);
}

void CommandMux::set_timeout(double timeout) {
  for (Source& source : sources_) source.input.set_silence(std::max(silence_needed(timeout), source.given.timeout));
}

void CommandMux::start(const EarlierController& earlier) {
  unread_ns_ = unread_ns(earlier.period_ns);
  for (Source& source : sources_) source.input.start(earlier);
}

void CommandMux::receive(std::size_t source, const ArrivedCommand& arrived, const ArrivalTime& time) {
  Source& from = sources_[source];
  const std::uint64_t before = from.input.value().count;
  from.input.receive(arrived, time);
  const bool accepted = from.input.value().count != before;
  if (accepted) from.last_ns = time.loop_ns - from.input.value().age_ns;
  select(time.loop_ns);
  message_ns_ = time.loop_ns;
  update_result(time.loop_ns, true);
  if (accepted && winner_ == source && value_.contested == kNotFiniteBefore) value_.contested = kNotFiniteMessage;
}

void CommandMux::receive_lock(std::size_t lock, bool set, std::int64_t loop_ns) {
  locks_[lock].set = set;
  locks_[lock].last_ns = loop_ns;
  update(loop_ns);
}

bool CommandMux::update(std::int64_t loop_ns) {
  bool changed = false;
  for (Source& source : sources_) changed |= source.input.update(loop_ns);
  changed |= select(loop_ns);
  if (!changed && (winner_ || unread(loop_ns))) return false;
  update_result(loop_ns, false);
  return true;
}

bool CommandMux::follow(const MotionPermission& permission, std::int64_t loop_ns) {
  bool ended = false;
  for (Source& source : sources_) {
    if (!source.input.follow(permission, loop_ns)) continue;
    source.last_ns.reset();
    ended = true;
  }
  if (!ended) return false;
  select(loop_ns);
  update_result(loop_ns, false);
  return true;
}

std::vector<std::string> CommandMux::revoked() const {
  std::set<std::string> names;
  for (const Source& source : sources_) {
    for (std::string& name : source.input.revoked()) names.insert(std::move(name));
  }
  return {names.begin(), names.end()};
}

bool CommandMux::select(std::int64_t loop_ns) {
  std::optional<std::size_t> highest;
  for (std::size_t i = 0; i < locks_.size(); ++i) {
    Lock& lock = locks_[i];
    const bool silent = lock.given.timeout > 0 && !recent(lock.last_ns, lock.given.timeout, loop_ns);
    lock.locks = lock.set || silent;
    if (lock.locks && (!highest || lock.given.priority > locks_[*highest].given.priority)) highest = i;
  }
  std::optional<std::size_t> winner;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    Source& source = sources_[i];
    source.live = recent(source.last_ns, source.given.timeout, loop_ns);
    source.lock.reset();
    if (highest && source.given.priority < locks_[*highest].given.priority) source.lock = highest;
    if (!winner && source.live && !source.lock) winner = i;
  }
  if (std::exchange(winner_, winner) == winner) return false;
  lines_.push_back({false, winner ? "commands come from " + sources_[*winner].given.name : "no source commands: zero"});
  return true;
}

void CommandMux::update_result(std::int64_t loop_ns, bool message) {
  value_.content = {};
  value_.age_ns = 0;
  value_.many_senders = 0;
  if (winner_) {
    const Source& source = sources_[*winner_];
    const VelocityCommand& command = source.input.value();
    value_.content = command.content;
    value_.age_ns = std::max<std::int64_t>(0, loop_ns - source.last_ns.value_or(loop_ns));
    value_.many_senders = command.many_senders;
  }
  const bool pending = std::ranges::any_of(
      sources_, [](const Source& source) { return source.live && parts_of(source.input.value().content) != 0; });
  const bool requested =
      pending || std::ranges::any_of(sources_, [&](Source& source) { return source.input.motion_requested(loop_ns); });
  const bool rests = parts_of(value_.content) == 0;
  value_.contested = rests && requested ? 1 : 0;
  if (rests && !message && !pending) value_.contested = unread(loop_ns) ? 1 : kNoMessage;
  if (winner_ && sources_[*winner_].input.value().contested == kNotFiniteMessage) value_.contested = kNotFiniteBefore;
  ++value_.count;
  add_refusals();
}

bool CommandMux::unread(std::int64_t loop_ns) const {
  return message_ns_ && std::abs(loop_ns - *message_ns_) < unread_ns_;
}

void CommandMux::add_refusals() {
  value_.stale = value_.crowded = value_.revoked = value_.not_finite = 0;
  for (const Source& source : sources_) {
    value_.stale += source.input.value().stale;
    value_.crowded += source.input.value().crowded;
    value_.revoked += source.input.value().revoked;
    value_.not_finite += source.input.value().not_finite;
  }
}

std::vector<ReportLine> CommandMux::lines() {
  std::vector<ReportLine> lines = std::exchange(lines_, {});
  for (Source& source : sources_) {
    for (ReportLine& line : source.input.lines()) {
      if (line.warning) lines.push_back({true, source.given.name + ": " + line.text});
    }
  }
  return lines;
}

std::vector<std::string> CommandMux::senders(std::int64_t loop_ns) {
  std::set<std::string> names;
  for (Source& source : sources_) {
    for (std::string& name : source.input.senders(loop_ns)) names.insert(std::move(name));
  }
  return {names.begin(), names.end()};
}

std::string CommandMux::winner() const {
  return winner_ ? sources_[*winner_].given.name : "";
}

std::vector<std::string> CommandMux::states() const {
  std::vector<std::string> states;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Source& source = sources_[i];
    std::string state = "commands";
    if (!source.live) {
      state = source.input.revoked().empty() ? "silent" : "revoked";
    } else if (source.lock) {
      state = "locked by " + locks_[*source.lock].given.name;
    } else if (winner_ != i) {
      state = "masked by " + winner();
    }
    states.push_back(source.given.name + ": " + state);
  }
  return states;
}

}  // namespace robot_control
