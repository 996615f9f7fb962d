#include "gate/stop_action.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

JointCommand JointStop::step(const StopAction& action, std::optional<double> position, double dt) noexcept {
  const JointCommand damped{.mode = JointMode::kVelocity, .damping = action.damping};
  switch (action.kind) {
    case StopKind::kCoast:
      return {.mode = JointMode::kEffort};
    case StopKind::kDamp:
      return damped;
    case StopKind::kMove:
      break;
    case StopKind::kBrake:
      return {};
  }
  if (!begin_) begin_ = position;
  elapsed_ += dt;
  if (lost_ || elapsed_ >= action.brake_after) return {};
  if (!begin_) return damped;
  const double falling = std::min(1 / kFirstRateShare, left_ / kEndShare) / action.time;
  left_ = std::max(0.0, left_ - falling * dt);
  const double own = *begin_ - action.target, usual = action.start - action.target;
  const bool ahead = own * usual > 0 && std::abs(own) < std::abs(usual);
  const double path = ahead ? usual : own;
  const double begun = ahead ? own / usual : 1;
  const double wanted = action.target + std::min(left_, begun) * path;
  lost_ = position && std::abs(*position - wanted) > kMaxDeviation;
  if (lost_) return {};
  if (elapsed_ >= action.time) return damped;
  const double held = std::min(1.0, (action.time - elapsed_) / (kFadeShare * action.time));
  return {.mode = JointMode::kImpedance,
          .position = wanted,
          .velocity = left_ < begun ? -falling * path : 0,
          .stiffness = held * action.stiffness,
          .damping = action.damping};
}

}  // namespace robot_control
