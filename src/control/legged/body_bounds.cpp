#include "control/legged/body_bounds.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "control/legged/foot_forces.h"
#include "control/legged/leg_controller.h"
#include "machine/legs/leg_dynamics.h"

namespace robot_control {
namespace {

constexpr double kPart = 0.5;
constexpr double kFriction = 0.5;
constexpr double kMinimum = 0.1;  // m/s² and rad/s²
constexpr double kSmall = 0.01;   // m/s² and rad/s², at which no foot lifts
constexpr double kSettle = 0.05;  // s, of an axis that arrives

using Feet = std::array<Eigen::Vector3d, kLegs>;
using Axes = Eigen::Matrix<double, 6, 1>;

/// A robot that stands at its nominal pose, in the base's axes.
struct Stance {
  Feet feet{};  ///< m
  LeggedMotion motion;
  LeggedEquations equations;
  std::optional<LegPlace> short_leg;
};

Stance nominal_stance(const LegModel& robot) {
  const LegDynamics dynamics(robot);
  const double height = nominal_height(robot);
  Stance stance;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Eigen::Vector3d& foot = stance.feet[leg];
    foot = robot.legs[leg].kinematics.position(robot.legs[leg].lying);
    foot.z() = robot.belly + robot.legs[leg].foot_radius - height;
    middle += foot / kLegs;
  }
  for (int pass = 0; pass < 2; ++pass) {  // the centre of gravity comes above the middle of the feet
    const Eigen::Vector3d off = stance.equations.centre_of_gravity - middle;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      if (pass > 0) stance.feet[leg].head<2>() += off.head<2>();
      const LegSolution solution = robot.legs[leg].kinematics.inverse(stance.feet[leg]);
      if (pass > 0 && solution.reach != FootReach::kReached) stance.short_leg = static_cast<LegPlace>(leg);
      for (std::size_t i = 0; i < kLegJoints; ++i)
        stance.motion.angles[kLegJoints * leg + i] = solution.angles[static_cast<Eigen::Index>(i)];
    }
    dynamics.step(stance.motion, stance.equations);
  }
  return stance;
}

/// Returns the forces of the feet that carry the weight and accelerate the body so, while they stand.
Feet forces(const LegModel& robot, const Stance& stance, const Axes& acceleration) {
  Eigen::Matrix<double, kLeggedDofs, 1> all;
  all.head<6>() = acceleration;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Eigen::Vector3d foot;
    const Eigen::Matrix3d jacobian =
        robot.legs[leg].kinematics.jacobian(LegModel::angles_of(stance.motion.angles, leg), foot);
    const Eigen::Vector3d moved = acceleration.head<3>() + acceleration.tail<3>().cross(foot);
    all.segment<3>(static_cast<Eigen::Index>(6 + kLegJoints * leg)) = -jacobian.inverse() * moved;
  }
  const Eigen::Matrix<double, kLeggedDofs, 1> efforts = stance.equations.mass * all + stance.equations.bias;
  FootForcesInput load{.feet = stance.feet, .force = efforts.head<3>(), .moment = efforts.segment<3>(3)};
  load.share.fill(1);
  return foot_forces(load);
}

}  // namespace

double nominal_height(const LegModel& robot) noexcept {
  const LegGeometry& first = robot.legs[0].kinematics.geometry();
  return leg_tuning(robot).height - first.hip.z() - first.upper.z() + robot.belly + robot.legs[0].foot_radius;
}

std::optional<LegPlace> short_leg(const LegModel& robot) {
  return nominal_stance(robot).short_leg;
}

std::array<AxisBounds, 6> body_bounds(const LegModel& robot) {
  const Stance stance = nominal_stance(robot);
  const Feet weight = forces(robot, stance, Axes::Zero());
  const double time = std::sqrt(robot.leg_length() / 0.426);
  std::array<AxisBounds, 6> bounds;
  for (std::size_t axis = 0; axis < bounds.size(); ++axis) {
    const Feet moved = forces(robot, stance, kSmall * Axes::Unit(static_cast<Eigen::Index>(axis)));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const Eigen::Vector3d change = (moved[leg] - weight[leg]) / kSmall;
      const double carried = kFriction * weight[leg].z() / (change.head<2>().norm() + kFriction * std::abs(change.z()));
      least = std::min(least, std::isfinite(carried) ? carried : 0);
    }
    bounds[axis] = {.speed = axis < 3 ? 0.4 * time : 0.9 / std::max(1.0, time),
                    .acceleration = std::max(kMinimum, kPart * least)};
  }
  return bounds;
}

double lying_down_time(const LegModel& robot) {
  const LegTuning tuning = leg_tuning(robot);
  const std::array<AxisBounds, 6> bounds = body_bounds(robot);
  const double ranges[6] = {tuning.sway, tuning.sway, tuning.bob, tuning.lean, tuning.lean, tuning.lean};
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
