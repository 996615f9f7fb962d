#pragma once
/// WithdrawalTime holds the time before which requests of motion have no effect. It is pure.
///
/// This is the present time while a stop is latched, and whenever a permission to drive has ended since the last look.
/// Waiting for the first permission ends no request: a motion that is requested meanwhile may begin with the
/// permission.

#include <cstdint>
#include <optional>

#include "signals/permit.h"

namespace robot_control {

class WithdrawalTime {
 public:
  /// Updates the time at each tick; `now_ns` is in ns of any clock that never goes backwards.
  void update(const Permit& permit, std::int64_t now_ns) {
    const bool granted = permit.action == PermitAction::kDrive;
    const bool ended = granted_ && (!granted || permit.withdrawals != withdrawals_);
    if (ended || permit.causes != 0) last_ns_ = now_ns;
    granted_ = granted;
    withdrawals_ = permit.withdrawals;
  }

  /// Returns the time, or nothing if there has been neither a stop nor an end of a permission.
  std::optional<std::int64_t> last_ns() const { return last_ns_; }

 private:
  std::optional<std::int64_t> last_ns_;
  std::uint64_t withdrawals_ = 0;
  bool granted_ = false;
};

}  // namespace robot_control
