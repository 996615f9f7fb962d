#include "log/motion_watch.h"

namespace robot_control {
namespace {

bool moves(const JoinedRow& row) noexcept {
  if (row.driver == nullptr || row.estimator == nullptr || row.controller == nullptr || row.monitor == nullptr) {
    return true;
  }
  return (row.estimator->state.base.flags & kStateStandstill) == 0 || !zero(row.controller->command.requested.twist);
}

}  // namespace

bool MotionWatch::step(const JoinedRow& row, std::int64_t time_ns) noexcept {
  bool event = moves(row);
  if (row.monitor != nullptr) {
    const auto state = static_cast<std::uint64_t>(row.monitor->permit.state);
    event = event || state != state_ || row.monitor->permit.causes != causes_;
    state_ = state;
    causes_ = row.monitor->permit.causes;
  }
  if (event) until_ns_ = time_ns + kAfter;
  return time_ns < until_ns_;
}

}  // namespace robot_control
