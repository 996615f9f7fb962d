#include "control/legged/walking/walking_speed.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "control/legged/walking/swing.h"

namespace robot_control {
namespace {

constexpr double kFastest = 10;  // m/s, rad/s
constexpr int kHalvings = 12;
constexpr int kSamples = 24;

/// Returns the largest part of its speed limit that a joint needs at this twist; ∞ where a leg does not reach.
double needed(const LegModel& robot, const NominalStance& stance, const Gait& gait,
              const WalkingTwist& twist) noexcept {
  const double time = gait.swing_time(), half = gait.stance_time() / 2;
  double part = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegKinematics& kinematics = robot.legs[leg].kinematics;
    const Eigen::Vector3d& foot = stance.feet[leg];
    // A foot that stands moves backwards under the body with this velocity.
    const Eigen::Vector3d velocity(twist[2] * foot.y() - twist[0], -twist[2] * foot.x() - twist[1], 0);
    const Eigen::Vector3d from = foot + half * velocity, to = foot - (half + time) * velocity;  // over ground
    for (int i = 0; i <= kSamples; ++i) {
      const double swung = static_cast<double>(i) / kSamples;
      const SwingPoint point = swing_point(from, to, foot.z() + gait.lift, swung, time);
      const LegSolution solution = kinematics.inverse(point.place + swung * time * velocity);
      if (solution.reach != FootReach::kReached) return std::numeric_limits<double>::infinity();
      Eigen::Vector3d place;
      const Eigen::Matrix3d inverse = kinematics.jacobian(solution.angles, place).inverse();
      const Eigen::Vector3d rates = inverse * (point.velocity + velocity);
      for (std::size_t j = 0; j < kLegJoints; ++j)
        part = std::max(
            part, std::abs(rates[static_cast<Eigen::Index>(j)]) / robot.joints[kLegJoints * leg + j].velocity_limit);
    }
  }
  return part;
}

}  // namespace

Gait gait_of(const LegModel& robot, const NominalStance& stance, const Gait& reference) noexcept {
  Gait gait = reference.scaled(robot.leg_length());
  if (gait.duty < 1) gait.lift *= std::min(1.0, kOfLift / needed(robot, stance, gait, {}));
  return gait;
}

WalkingTwist walking_speed(const LegModel& robot, const NominalStance& stance, const Gait& gait) noexcept {
  WalkingTwist result{kMinSpeed, kMinSpeed, kMinSpeed};
  if (gait.duty >= 1) return result;
  for (std::size_t axis = 0; axis < result.size(); ++axis) {
    double low = 0, high = kFastest;
    for (int i = 0; i < kHalvings; ++i) {
      WalkingTwist twist{};
      twist[axis] = (low + high) / 2;
      (needed(robot, stance, gait, twist) <= kOfJointSpeed ? low : high) = twist[axis];
    }
    result[axis] = std::max(kMinSpeed, low);
  }
  return result;
}

double walk_ending_time(const LegControllerParameters& parameters, const LegModel& robot) noexcept {
  double slowest = 0, period = 0;
  for (const MotionLimits& axis : twist_limits(parameters))
    slowest = std::max(slowest, axis.speed / axis.emergency_deceleration + axis.emergency_deceleration / axis.jerk);
  for (const Gait& gait : kGaits) period = std::max(period, gait.scaled(robot.leg_length()).period);
  return slowest + period + kAllDown;
}

}  // namespace robot_control
