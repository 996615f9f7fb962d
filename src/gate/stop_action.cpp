#include "gate/stop_action.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

// Parts of the time of a fold.
constexpr double kQuick = 0.64;
constexpr double kGentle = 0.18;
constexpr double kFade = 0.2;
constexpr double kRest = 1.2;

constexpr double kLost = 0.25;  // rad or m

}  // namespace

JointCommand JointStop::step(std::optional<double> position, double dt, bool walked) noexcept {
  const JointCommand damped{.mode = JointMode::kVelocity, .damping = action_.damping};
  switch (action_.kind) {
    case StopKind::kCoast:
      return {.mode = JointMode::kEffort};
    case StopKind::kDamp:
      return damped;
    case StopKind::kFold:
      break;
    case StopKind::kBrake:
      return {};
  }
  if (!begin_) begin_ = position;
  elapsed_ += dt;
  if (lost_ || elapsed_ >= kRest * action_.time) return {};
  if (!begin_) return damped;
  const double time = walked ? action_.walking_time : action_.time;
  const double falling = std::min(1 / kQuick, left_ / kGentle) / time;
  left_ = std::max(0.0, left_ - falling * dt);
  const double own = *begin_ - action_.posture, usual = action_.upright.value_or(*begin_) - action_.posture;
  const bool ahead = own * usual > 0 && std::abs(own) < std::abs(usual);
  const double path = ahead ? usual : own;
  const double begun = ahead ? own / usual : 1;
  const double wanted = action_.posture + std::min(left_, begun) * path;
  lost_ = position && std::abs(*position - wanted) > kLost;
  if (lost_) return {};
  if (elapsed_ >= time) return damped;
  const double held = std::min(1.0, (time - elapsed_) / (kFade * time));
  return {.mode = JointMode::kImpedance,
          .position = wanted,
          .velocity = left_ < begun ? -falling * path : 0,
          .stiffness = held * action_.stiffness,
          .damping = action_.damping};
}

}  // namespace robot_control
