#include "control/legged/stand/body_bounds.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "control/legged/leg_controller.h"
#include "control/legged/stand/foot_forces.h"
#include "control/legged/stand/nominal_stance.h"
#include "control/legged/walk/gait.h"

namespace robot_control {
namespace {

constexpr double kUsedShare = 0.5;
constexpr double kFriction = 0.5;
constexpr double kMinimum = 0.1;             // m/s² and rad/s²
constexpr double kSmallAcceleration = 0.01;  // m/s² and rad/s², at which no foot lifts
constexpr double kSettle = 0.05;             // s, of an axis that arrives

using Feet = std::array<Eigen::Vector3d, kLegs>;
using Axes = Eigen::Matrix<double, 6, 1>;

/// Returns the forces of the feet that carry the weight and accelerate the body so, while they stand.
Feet forces(const LegModel& robot, const NominalStance& stance, const Axes& acceleration) {
  Eigen::Matrix<double, kLeggedDofs, 1> all;
  all.head<6>() = acceleration;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Eigen::Vector3d foot;
    const Eigen::Matrix3d jacobian =
        robot.legs[leg].kinematics.jacobian(LegModel::angles_of(stance.motion.angles, leg), foot);
    const Eigen::Vector3d moved = acceleration.head<3>() + acceleration.tail<3>().cross(foot);
    all.segment<3>(6 + kLegJoints * leg) = -jacobian.inverse() * moved;
  }
  const Eigen::Matrix<double, kLeggedDofs, 1> efforts = stance.equations.mass * all + stance.equations.bias;
  FootForcesInput load{.feet = stance.feet, .force = efforts.head<3>(), .moment = efforts.segment<3>(3)};
  load.share.fill(1);
  return foot_forces(load);
}

}  // namespace

std::array<AxisBounds, 6> body_bounds(const LegModel& robot) {
  const NominalStance stance = nominal_stance(robot);
  const Feet weight = forces(robot, stance, Axes::Zero());
  const double time = std::sqrt(robot.leg_length() / kReferenceLeg);
  std::array<AxisBounds, 6> bounds;
  for (std::size_t axis = 0; axis < bounds.size(); ++axis) {
    const Feet moved = forces(robot, stance, kSmallAcceleration * Axes::Unit(axis));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const Eigen::Vector3d change = (moved[leg] - weight[leg]) / kSmallAcceleration;
      const double carried = kFriction * weight[leg].z() / (change.head<2>().norm() + kFriction * std::abs(change.z()));
      least = std::min(least, std::isfinite(carried) ? carried : 0);
    }
    bounds[axis] = {.speed = axis < 3 ? 0.4 * time : 0.9 / std::max(1.0, time),
                    .acceleration = std::max(kMinimum, kUsedShare * least)};
  }
  return bounds;
}

double lying_down_time(const LegModel& robot) {
  const LegTuning tuning = leg_tuning(robot);
  const std::array<AxisBounds, 6> bounds = body_bounds(robot);
  const double ranges[] = {tuning.sway, tuning.sway, tuning.bob, tuning.lean, tuning.lean, tuning.lean};
  double length = 0, slowest = 0;
  for (std::size_t axis = 0; axis < bounds.size(); ++axis) {
    length += ranges[axis] / bounds[axis].acceleration;
    slowest = std::max(slowest, ranges[axis] / bounds[axis].speed);
  }
  const double speed = std::min(std::sqrt(length), length / slowest);
  const double foot = (2 * tuning.foot_range + tuning.lift) / tuning.foot.speed +
                      4 * tuning.foot.speed / tuning.foot.acceleration + kLoadTime;
  return foot + length / speed + 2 * speed + kSettle + tuning.rise_time;
}

}  // namespace robot_control
