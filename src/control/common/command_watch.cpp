#include "control/common/command_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {

namespace {

constexpr std::uint64_t kNoTimeout = std::numeric_limits<std::uint64_t>::max();

/// Returns the whole periods in the rest of `timeout`. The margin keeps 1.25 s / 1 ms at 1250, although neither number
/// is exact in binary.
std::uint64_t cycles_left(double timeout, std::int64_t age_ns, double period) noexcept {
  constexpr double kMargin = 1e-6;
  if (timeout <= 0) return kNoTimeout;
  const double left = timeout - 1e-9 * static_cast<double>(age_ns);
  return static_cast<std::uint64_t>(std::max(0.0, std::floor(left / period + kMargin)));
}

std::uint64_t cycles_of_silence(double timeout, double period) noexcept {
  return cycles_left(silence_needed(timeout), 0, period);
}

}  // namespace

CommandWatch::CommandWatch(double timeout, double period, std::uint64_t executable)
    : timeout_(timeout), period_(period), executable_(executable), silence_needed_(cycles_of_silence(timeout, period)) {
  enter_run();
}

void CommandWatch::enter_run(const VelocityCommand& inbox, bool with_zero) noexcept {
  first_ = last_ = inbox;
  first_cycle_.reset();
  message_cycle_ = 0;
  zero_requests_ = with_zero ? 1 : 0;
  zero_requested_ = with_zero;
  life_ = request_cycle_ = not_finite_ = timeouts_ = without_effect_ = 0;
  reason_ = kReasonNoCommand;
  requested_ = {};
  ignored_ = partial_ = 0;
}

void CommandWatch::set_timeout(double timeout) noexcept {
  timeout_ = timeout;
  silence_needed_ = cycles_of_silence(timeout, period_);
  life_ = cycles_left(timeout_, last_.age_ns, period_);
}

void CommandWatch::accept(const VelocityCommand& request, std::uint64_t parts, std::uint64_t cycle) noexcept {
  request_cycle_ = cycle;
  life_ = cycles_left(timeout_, request.age_ns, period_);
  const bool refused = request.contested == kNotFiniteMessage || !finite(request.content);
  const bool good = !refused && request.contested != kNotFiniteBefore;
  reason_ = good ? 0u : std::uint64_t{kReasonRefused};
  requested_ = good ? request.content : Request{};
  ignored_ = good ? parts & ~executable_ : 0;
  if (ignored_ != 0) ++partial_;
  if (refused) ++not_finite_;
}

void CommandWatch::note_messages(const VelocityCommand& request, std::uint64_t parts, std::uint64_t cycle) noexcept {
  const bool first = !first_cycle_.has_value();
  if (first) first_cycle_ = message_cycle_ = cycle;
  const bool refused = request.stale != last_.stale || request.crowded != last_.crowded ||
                       request.revoked != last_.revoked || request.not_finite != last_.not_finite;
  const bool accepted = request.count != last_.count && request.contested != kNoMessage;
  if (!refused && !accepted) return;
  message_cycle_ = cycle;
  zero_requested_ = !first && !refused && parts == 0 && request.contested == 0 && request.many_senders == 0;
  if (zero_requested_) ++zero_requests_;
}

const Request& CommandWatch::step(const VelocityCommand& request, std::uint64_t cycle) noexcept {
  const std::uint64_t parts = request.count != last_.count ? parts_of(request.content) : 0;
  note_messages(request, parts, cycle);
  if (request.stale != last_.stale) without_effect_ |= kReasonStale;
  if (request.revoked != last_.revoked) without_effect_ |= kReasonRevoked;
  if (request.count != last_.count) {
    without_effect_ = 0;
    accept(request, parts, cycle);
  }
  if (request.many_senders != 0) {
    reason_ = kReasonManySenders;
    requested_ = {};
    ignored_ = 0;
  } else if (reason_ == 0 && cycle - request_cycle_ > life_) {
    ++timeouts_;
    reason_ = kReasonTimedOut;
    requested_ = {};
    ignored_ = 0;
  }
  last_ = request;
  return requested_;
}

void CommandWatch::report(std::uint64_t cycle, CommandFrame& out) const noexcept {
  out.request_cycle = request_cycle();
  out.requests_received = received();
  out.requests_refused = refused();
  out.requests_stale = stale();
  out.requests_crowded = crowded();
  out.requests_revoked = revoked();
  out.requests_partial = partial();
  out.ignored = ignored();
  out.timeouts = timeouts();
  out.first_cycle = first_cycle();
  out.zero_requests = zero_requests();
  out.zero_requested = zero_requested() ? 1 : 0;
  out.silent_cycles = silent_cycles(cycle);
  out.silence_needed = silence_needed();
}

}  // namespace robot_control
