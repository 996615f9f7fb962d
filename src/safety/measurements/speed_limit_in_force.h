#pragma once
/// The largest speed limit of the last ramp_time to 2·ramp_time: every limit below it has been in force for long
/// enough.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "signals/permit.h"

namespace robot_control {

class SpeedLimitInForce {
 public:
  SpeedLimitInForce(double ramp_time, double period) noexcept
      : cycles_(static_cast<std::uint64_t>(std::llround(ramp_time / period))) {}

  void enter_run() noexcept {
    since_ = 0;
    last_ = now_ = kNoSpeedLimit;
  }

  /// m/s
  double step(double speed_limit, std::uint64_t elapsed) noexcept {
    now_ = std::max(now_, speed_limit);
    since_ += elapsed;
    if (since_ >= cycles_) {
      since_ = 0;
      last_ = now_;
      now_ = speed_limit;
    }
    return std::max(last_, now_);
  }

 private:
  std::uint64_t cycles_;
  std::uint64_t since_ = 0;
  double last_ = kNoSpeedLimit;  ///< the largest of the last full ramp_time
  double now_ = kNoSpeedLimit;   ///< the largest since then
};

}  // namespace robot_control
