#pragma once
/// Until when were requests of motion void? Pure.
///
/// Until now while a stop is latched, and whenever a permission to drive has ended since the last look. The waiting for
/// a first permission ends none: what is requested meanwhile may begin with it.

#include <cstdint>
#include <optional>

#include "signals/permit.h"

namespace robot_control {

class WithdrawalTime {
 public:
  /// At each tick; ns of any clock that never turns back.
  void look(const Permit& permit, std::int64_t now_ns) {
    const bool granted = permit.action == PermitAction::kDrive;
    const bool ended = granted_ && (!granted || permit.withdrawals != withdrawals_);
    if (ended || permit.causes != 0) last_ns_ = now_ns;
    granted_ = granted;
    withdrawals_ = permit.withdrawals;
  }

  /// None: never.
  std::optional<std::int64_t> last_ns() const { return last_ns_; }

 private:
  std::optional<std::int64_t> last_ns_;
  std::uint64_t withdrawals_ = 0;
  bool granted_ = false;
};

}  // namespace robot_control
