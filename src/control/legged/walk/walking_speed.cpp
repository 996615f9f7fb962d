#include "control/legged/walk/walking_speed.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr double kFastest = 10;      // m/s, rad/s
constexpr double kFastestLeg = 1.7;  // m/s, ahead, of legs of kReferenceLeg
constexpr int kHalvings = 12;

/// Returns the largest speed on this axis, either way, for which `part_of` returns at most kSpeedShare.
template <class Part>
double largest(std::size_t axis, const Part& part_of) noexcept {
  double low = 0, high = kFastest;
  for (int i = 0; i < kHalvings; ++i) {
    const double speed = (low + high) / 2;
    WalkingTwist ahead{}, back{};
    ahead[axis] = speed;
    back[axis] = -speed;
    (std::max(part_of(ahead), part_of(back)) <= kSpeedShare ? low : high) = speed;
  }
  return std::max(kMinSpeed, low);
}

}  // namespace

Gait gait_of(const LegModel& robot, const NominalStance& stance, const Gait& reference) noexcept {
  Gait gait = reference.scaled(robot.leg_length());
  if (gait.duty < 1) gait.lift *= std::min(1.0, kLiftSpeedShare / LegUse(robot, stance).swinging(gait, {}));
  return gait;
}

Speeds walking_speeds(const LegModel& robot, const NominalStance& stance, const Gaits& gaits) {
  const LegUse legs(robot, stance);
  Speeds speeds(gaits.size());
  for (std::size_t i = 0; i < gaits.size(); ++i) {
    speeds[i].fill(kMinSpeed);
    if (gaits[i].duty >= 1) continue;
    for (std::size_t axis = 0; axis < speeds[i].size(); ++axis)
      speeds[i][axis] = largest(axis, [&](const WalkingTwist& twist) { return legs.steady(gaits[i], twist); });
  }
  for (std::size_t next = 0; next < gaits.size(); ++next) {
    for (std::size_t last = 0; last < gaits.size(); ++last) {
      if (gaits[next].duty >= 1 || gaits[last].duty >= 1) continue;
      for (std::size_t axis = 0; axis < speeds[next].size(); ++axis) {
        const double change =
            largest(axis, [&](const WalkingTwist& twist) { return legs.changing(gaits[last], gaits[next], twist); });
        double& slower = speeds[last][axis] < speeds[next][axis] ? speeds[last][axis] : speeds[next][axis];
        slower = std::min(slower, change);
      }
    }
  }
  const double fastest = kFastestLeg * std::sqrt(robot.leg_length() / kReferenceLeg);
  for (WalkingTwist& speed : speeds) speed[0] = std::min(speed[0], fastest);
  return speeds;
}

double walk_ending_time(const LegControllerParameters& parameters, const LegModel& robot) {
  double slowest = 0, period = 0;
  for (const MotionLimits& axis : twist_limits(parameters))
    slowest = std::max(slowest, axis.speed / axis.emergency_deceleration + axis.emergency_deceleration / axis.jerk);
  for (const Gait& gait : all_gaits(parameters.gaits))
    period = std::max(period, gait.scaled(robot.leg_length()).period);
  return slowest + period + kAllDown;
}

}  // namespace robot_control
