#include "estimation/legged/ground.h"

namespace robot_control {

using Eigen::Vector3d;

void Ground::footfall(std::size_t foot, double deviation, LegFilter& filter, State& state) const noexcept {
  state.fallen[foot] = 1;
  if (state.fallen != std::array<std::uint64_t, kLegs>{1, 1, 1, 1} || !level(foot, deviation, filter, state)) return;
  if (state.known != 0 && filter.touch(foot, deviation, kPlaneGate)) return;
  filter.set_ground(foot, deviation);
  state.known = 1;
}

bool Ground::level(std::size_t foot, double deviation, const LegFilter& filter, State& state) const noexcept {
  const auto place = [&](LegPlace leg) { return filter.foot(static_cast<std::size_t>(leg)); };
  const Vector3d now = (place(LegPlace::kFrontRight) - place(LegPlace::kRearLeft))
                           .cross(place(LegPlace::kFrontLeft) - place(LegPlace::kRearRight))
                           .normalized();
  Eigen::Map<Vector3d> normal(state.normal.data());
  normal += (now - normal) / kFootfalls;
  const double slope = deviation / (2 * length_);
  const double limit = kLevelGate * kLevelGate * (slope * slope + filter.tilt_variance());
  bool level = now.head<2>().squaredNorm() <= limit && normal.head<2>().squaredNorm() <= limit;
  for (std::size_t other = 0; other < kLegs; ++other)
    level = level && (other == foot || filter.as_high(foot, other, deviation, kLevelGate));
  return level;
}

}  // namespace robot_control
