#include "control/wheeled/wheel_loops/ground_friction.h"

#include <utility>

namespace robot_control {

GroundFriction::GroundFriction(const DriveTrain& robot) noexcept
    : scrub_(robot), wheels_(std::min(robot.wheels.size(), kMaxWheels)) {
  for (std::size_t i = 0; i < wheels_; ++i) max_square_ += scrub_.max_effort(i) * scrub_.max_effort(i);
}

void GroundFriction::search(const Turn& turn, double dt) noexcept {
  if (turns(strain_square()) <= 0) return;
  const bool followed = std::exchange(state_.follows, turn.part >= kFollowedShare);
  if (followed) {
    state_.taken = turn.effort;
    state_.impulse = turn.momentum + kObserverTime * turn.effort;
  }
  state_.impulse += (turn.effort - state_.taken) * dt;
  state_.taken = (state_.impulse - turn.momentum) / kObserverTime;
  if (!state_.follows) {
    state_.friction = std::max(state_.friction, std::min(state_.friction + kSearchRate * dt, kMaxSearched));
    return;
  }
  state_.found += state_.slid;
  if (!followed) raise(std::min(0.0, state_.taken - turn.integral - state_.friction));
}

double GroundFriction::raise(double by) noexcept {
  const double before = state_.friction;
  state_.friction = std::clamp(before + by, 0.0, kMaxGroundFriction);
  return state_.friction - before;
}

}  // namespace robot_control
