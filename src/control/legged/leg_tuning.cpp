#include "control/legged/leg_tuning.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "machine/gravity.h"
#include "signals/legged/legged_command.h"

namespace robot_control {
namespace {

/// Returns the knee that needs the largest part of its torque for half of the weight, at that height [m].
LoadedKnee loaded_knee_at(const LegModel& robot, double height) noexcept {
  LoadedKnee worst;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const std::size_t joint = kLegJoints * leg + 2;
    const double effort = robot.mass * kGravity / 2 * robot.legs[leg].kinematics.knee_lever(height);
    const double part = effort / robot.joints[joint].effort_limit;
    if (part > worst.part) worst = {joint, effort, part};
  }
  return worst;
}

double standing_height(const LegModel& robot) noexcept {
  constexpr double kLowest = 0.7, kHighest = 0.85, kStep = 0.01;  // of the leg length
  constexpr double kKneeShare = 0.6;
  double height = kLowest;
  while (height < kHighest && loaded_knee_at(robot, height * robot.leg_length()).part > kKneeShare) height += kStep;
  return height * robot.leg_length();
}

/// Returns the largest part of its speed limit that a joint needs while the foot is at `place` [m] and moves upward
/// [m/s]. It is 0 where the leg does not reach it.
double needed_speed(const LegModel& robot, std::size_t leg, const Eigen::Vector3d& place, double upward) noexcept {
  const LegKinematics& kinematics = robot.legs[leg].kinematics;
  const std::optional<LegAngles> angles = kinematics.reached(place);
  if (!angles) return 0;
  Eigen::Vector3d foot;
  const Eigen::Vector3d rates = kinematics.jacobian(*angles, foot).inverse().col(2) * upward;
  double part = 0;
  for (std::size_t i = 0; i < kLegJoints; ++i)
    part = std::max(part, std::abs(rates[i]) / robot.joints[kLegJoints * leg + i].velocity_limit);
  return part;
}

/// Returns the time in s in which the body rises above its feet, and no joint is faster than kLimitShare of its limit.
double fastest_rise(const LegModel& robot) noexcept {
  constexpr int kParts = 20;
  double time = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegGeometry& geometry = robot.legs[leg].kinematics.geometry();
    Eigen::Vector3d foot = robot.legs[leg].kinematics.position(robot.legs[leg].lying);
    const double lies = robot.belly + robot.legs[leg].foot_radius;
    const double rise = lies - (geometry.hip.z() + geometry.upper.z() - standing_height(robot));
    for (int i = 1; i < kParts; ++i) {
      const double s = static_cast<double>(i) / kParts;
      foot.z() = lies - s * s * (3 - 2 * s) * rise;
      time = std::max(time, needed_speed(robot, leg, foot, -6 * s * (1 - s) * rise) / kLimitShare);
    }
  }
  return time;
}

}  // namespace

LoadedKnee loaded_knee(const LegModel& robot) noexcept {
  return loaded_knee_at(robot, standing_height(robot));
}

// These are the values of a robot of kReferenceMass with legs of kReferenceLeg.
LegTuning leg_tuning(const LegModel& robot) noexcept {
  const double length = robot.leg_length() / kReferenceLeg, mass = robot.mass / kReferenceMass;
  const double time = std::sqrt(length);
  LegTuning tuning;
  tuning.stiffness = 60 * mass * length;
  tuning.damping = 2 * mass * length * time;
  tuning.rise_time = std::max(1.3 * time, fastest_rise(robot));
  tuning.height = standing_height(robot);
  tuning.lift = 0.08 * length;
  tuning.sway = 0.12 * robot.leg_length();
  tuning.bob = 0.16 * robot.leg_length();
  tuning.lean = 0.3;
  tuning.foot_range = 0.15 * length;
  tuning.foot = {.speed = 0.5 * time, .acceleration = 15};
  tuning.joint = {.speed = 3 / time, .acceleration = 15 / length};
  return tuning;
}

double within(double value, double range, std::uint64_t& reasons) noexcept {
  if (std::abs(value) > range) reasons |= kReasonOutOfReach;
  return std::clamp(value, -range, range);
}

AllJointBounds joint_bounds(const LegModel& robot) noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const AxisBounds motion = leg_tuning(robot).joint;
  AllJointBounds bounds;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const JointModel& joint = robot.joints[i];
    bounds[i].range = joint.range.value_or(JointRange{-kInfinity, kInfinity});
    bounds[i].motion = motion;
    bounds[i].motion.speed = std::min(motion.speed, kLimitShare * joint.velocity_limit);
  }
  return bounds;
}

}  // namespace robot_control
