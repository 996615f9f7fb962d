#include "control/command_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "signals/command_frame.h"

namespace robot_control {

namespace {

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

/// Whole periods in `timeout`. The margin keeps 1.25 s / 1 ms at 1250 although neither is exact in binary.
std::uint64_t whole_cycles(double timeout, double period) {
  constexpr double kRounding = 1e-6;
  return timeout > 0 ? static_cast<std::uint64_t>(std::floor(timeout / period + kRounding)) : kNever;
}

bool finite(const Twist& twist) noexcept {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  return std::all_of(twist.linear.begin(), twist.linear.end(), is_finite) &&
         std::all_of(twist.angular.begin(), twist.angular.end(), is_finite);
}

}  // namespace

CommandWatch::CommandWatch(double timeout, double period) : timeout_cycles_(whole_cycles(timeout, period)) {
  reset(0);
}

void CommandWatch::reset(std::uint64_t request_count) noexcept {
  first_count_ = last_count_ = request_count;
  request_cycle_ = refused_ = timeouts_ = 0;
  reason_ = kReasonNoCommand;
  wish_ = {};
}

const Twist& CommandWatch::step(const VelocityCommand& request, std::uint64_t cycle) noexcept {
  if (request.count != last_count_) {
    last_count_ = request.count;
    request_cycle_ = cycle;
    const bool good = finite(request.twist);
    reason_ = good ? 0u : std::uint64_t{kReasonRefused};
    wish_ = good ? request.twist : Twist{};
    if (!good) ++refused_;
  } else if (reason_ == 0 && cycle - request_cycle_ > timeout_cycles_) {
    ++timeouts_;
    reason_ = kReasonTimedOut;
    wish_ = {};
  }
  return wish_;
}

}  // namespace robot_control
