#include "navigation/guard/moving_outline.h"

#include <algorithm>
#include <limits>

#include "machine/bodies/posed_bodies.h"

namespace robot_control::navigation {

bool MovingOutline::changes() const {
  return std::ranges::any_of(robot_.bodies, [](const RigidBody& body) {
    return body.joint.type == JointType::kRevolute || body.joint.type == JointType::kPrismatic;
  });
}

void MovingOutline::update(const std::map<std::string, double>& positions, double now) {
  if (!lately_.empty() && now - lately_.back().first < kOutlinePeriod) return;
  lately_.emplace_back(now, footprint_of(posed(robot_, positions)));
  while (now - lately_.front().first > kStride) lately_.pop_front();
  footprint_ = footprint_of([&](Point normal) {
    double reach = -std::numeric_limits<double>::infinity();
    for (const auto& [at, outline] : lately_) {
      for (const Point corner : outline.corners) reach = std::max(reach, corner.x * normal.x + corner.y * normal.y);
    }
    return reach;
  });
}

}  // namespace robot_control::navigation
