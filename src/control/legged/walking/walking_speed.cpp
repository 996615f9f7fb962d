#include "control/legged/walking/walking_speed.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "control/legged/walking/swing.h"

namespace robot_control {
namespace {

constexpr double kFastest = 10;      // m/s, rad/s
constexpr double kFastestLeg = 1.7;  // m/s, ahead, of legs of kReferenceLeg
constexpr int kHalvings = 12;
constexpr int kSamples = 24;

constexpr double kOutOfReach = std::numeric_limits<double>::infinity();

/// Returns the largest part of its speed limit that a joint needs at this twist.
double needed(const LegModel& robot, const NominalStance& stance, const Gait& gait,
              const WalkingTwist& twist) noexcept {
  const double time = gait.swing_time(), half = gait.stance_time() / 2;
  double part = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d& foot = stance.feet[leg];
    const Eigen::Vector3d velocity = velocity_below(foot, twist);
    const Eigen::Vector3d from = foot + half * velocity, to = foot - (half + time) * velocity;  // over ground
    for (int i = 0; i <= kSamples; ++i) {
      const double swung = static_cast<double>(i) / kSamples;
      const SwingPoint point = swing_point(from, to, foot.z() + gait.lift, swung, time);
      part = std::max(part, needed_speed(robot, leg, point.place + swung * time * velocity, point.velocity + velocity));
    }
  }
  return part;
}

/// Returns the same of the feet that stand on where `last` ends, at the end of their first stance in `next`.
double needed_after(const LegModel& robot, const NominalStance& stance, const Gait& last, const Gait& next,
                    const WalkingTwist& twist) noexcept {
  const double begin = next.begins_after(last);
  double part = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const double stands = next.bears_for(leg, begin);
    if (stands == 0) continue;
    const double stood = last.period * (std::min(last.leg_phase(leg, 0), last.duty) - last.duty / 2);
    const Eigen::Vector3d& foot = stance.feet[leg];
    const Eigen::Vector3d velocity = velocity_below(foot, twist);
    part = std::max(part, needed_speed(robot, leg, foot + (stood + stands) * velocity, velocity));
  }
  return part;
}

/// Returns the largest speed on this axis, either way, for which `part_of` returns at most kOfJointSpeed.
template <class Part>
double largest(std::size_t axis, const Part& part_of) noexcept {
  double low = 0, high = kFastest;
  for (int i = 0; i < kHalvings; ++i) {
    const double speed = (low + high) / 2;
    WalkingTwist ahead{}, back{};
    ahead[axis] = speed;
    back[axis] = -speed;
    (std::max(part_of(ahead), part_of(back)) <= kOfJointSpeed ? low : high) = speed;
  }
  return std::max(kMinSpeed, low);
}

}  // namespace

double needed_speed(const LegModel& robot, std::size_t leg, const Eigen::Vector3d& place,
                    const Eigen::Vector3d& velocity) noexcept {
  const LegKinematics& kinematics = robot.legs[leg].kinematics;
  const std::optional<LegAngles> angles = kinematics.reached(place);
  if (!angles || kinematics.stretch(*angles) > kOfLength * kinematics.length()) return kOutOfReach;
  Eigen::Vector3d foot;
  const Eigen::Matrix3d inverse = kinematics.jacobian(*angles, foot).inverse();
  const Eigen::Vector3d rates = inverse * velocity;
  double part = 0;
  for (std::size_t i = 0; i < kLegJoints; ++i)
    part = std::max(part,
                    std::abs(rates[static_cast<Eigen::Index>(i)]) / robot.joints[kLegJoints * leg + i].velocity_limit);
  return part;
}

Eigen::Vector3d velocity_below(const Eigen::Vector3d& foot, const WalkingTwist& twist) noexcept {
  return {twist[2] * foot.y() - twist[0], -twist[2] * foot.x() - twist[1], 0};
}

Gait gait_of(const LegModel& robot, const NominalStance& stance, const Gait& reference) noexcept {
  Gait gait = reference.scaled(robot.leg_length());
  if (gait.duty < 1) gait.lift *= std::min(1.0, kOfLift / needed(robot, stance, gait, {}));
  return gait;
}

Speeds walking_speeds(const LegModel& robot, const NominalStance& stance, const Gaits& gaits) {
  Speeds speeds(gaits.size());
  for (std::size_t i = 0; i < gaits.size(); ++i) {
    speeds[i].fill(kMinSpeed);
    if (gaits[i].duty >= 1) continue;
    for (std::size_t axis = 0; axis < speeds[i].size(); ++axis)
      speeds[i][axis] =
          largest(axis, [&](const WalkingTwist& twist) { return needed(robot, stance, gaits[i], twist); });
  }
  for (std::size_t next = 0; next < gaits.size(); ++next) {
    for (std::size_t last = 0; last < gaits.size(); ++last) {
      if (gaits[next].duty >= 1 || gaits[last].duty >= 1) continue;
      for (std::size_t axis = 0; axis < speeds[next].size(); ++axis) {
        const double change = largest(axis, [&](const WalkingTwist& twist) {
          return needed_after(robot, stance, gaits[last], gaits[next], twist);
        });
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
