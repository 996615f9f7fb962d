#include "navigation/guard/moving_outline.h"

#include <algorithm>

#include "machine/bodies/posed_bodies.h"

namespace robot_control::navigation {

bool MovingOutline::changes() const {
  return std::ranges::any_of(robot_.bodies, [](const RigidBody& body) {
    return body.joint.type == JointType::kRevolute || body.joint.type == JointType::kPrismatic;
  });
}

void MovingOutline::update(const std::map<std::string, double>& positions, double now) {
  if (!times_.empty() && now - times_.back() < kOutlinePeriod) return;
  lately_.push_back(footprint_of(posed(robot_, positions)));
  times_.push_back(now);
  const auto old = std::ranges::find_if(times_, [&](double at) { return now - at <= kStride; }) - times_.begin();
  times_.erase(times_.begin(), times_.begin() + old);
  lately_.erase(lately_.begin(), lately_.begin() + old);
  footprint_ = hull_of(lately_);
}

}  // namespace robot_control::navigation
