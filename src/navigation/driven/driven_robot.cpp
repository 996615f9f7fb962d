#include "navigation/driven/driven_robot.h"

#include <algorithm>
#include <vector>

#include "control/legged/stand/nominal_stance.h"
#include "control/legged/walk/gait_table.h"
#include "machine/bodies/posed_bodies.h"
#include "robots/robot_kind.h"

namespace robot_control::navigation {
namespace {

/// Returns the bodies with each foot `moved` m from its nominal place, about which the robot has turned by `turn` rad.
RigidBodies stepping(const LegModel& robot, const NominalStance& stance, const Eigen::Vector3d& moved, double turn) {
  std::map<std::string, double> positions;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d foot = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * stance.feet[leg] + moved;
    const LegAngles angles = robot.legs[leg].kinematics.inverse(foot).angles;
    for (std::size_t i = 0; i < kLegJoints; ++i) positions[robot.joints[kLegJoints * leg + i].name] = angles[i];
  }
  return posed(*robot.bodies, positions);
}

Footprint walking_outline(const LegModel& robot, const DriveLimits& limits, double speed) {
  const NominalStance stance = nominal_stance(robot);
  std::vector<Footprint> outlines;
  for (const std::uint64_t index : {kSlowGait, kFastGait}) {
    const Gait gait = kGaits[index].scaled(robot.leg_length());
    for (const double lift : {0.0, gait.lift}) {
      for (const double half : {-gait.stance_time() / 2, gait.stance_time() / 2}) {
        for (const Eigen::Vector3d& twist : {Eigen::Vector3d(speed, 0, 0), Eigen::Vector3d(0, limits.lateral, 0),
                                             Eigen::Vector3d(0, 0, limits.angular)})
          outlines.push_back(
              footprint_of(stepping(robot, stance, {half * twist.x(), half * twist.y(), lift}, half * twist.z())));
      }
    }
  }
  return hull_of(outlines);
}

template <class Controller>
DriveLimits limits_within(const Controller& controller) {
  DriveLimits limits;
  limits.forward = controller.max_linear_speed;
  limits.reverse = std::min(limits.reverse, controller.max_linear_speed);
  limits.angular = std::min(limits.angular, controller.max_angular_speed);
  limits.linear_acceleration = controller.max_linear_acceleration;
  limits.angular_acceleration = controller.max_angular_acceleration;
  return limits;
}

DriveLimits limits_of(const DriveControllerParameters& wheels) {
  DriveLimits limits = limits_within(wheels);
  limits.reverse = std::min(limits.reverse, -wheels.min_linear_speed.value_or(-limits.reverse));
  for (const auto& other :
       {wheels.max_linear_deceleration, wheels.max_linear_acceleration_reverse, wheels.max_linear_deceleration_reverse})
    limits.linear_acceleration = std::min(limits.linear_acceleration, other.value_or(limits.linear_acceleration));
  limits.angular_acceleration =
      std::min(limits.angular_acceleration, wheels.max_angular_deceleration.value_or(limits.angular_acceleration));
  return limits;
}

DriveLimits limits_of(const LegControllerParameters& legs) {
  DriveLimits limits = limits_within(legs);
  limits.lateral = std::min(kMaxLateral, legs.max_lateral_speed);
  return limits;
}

}  // namespace

DrivenRobot driven_robot(const RobotDescription& description, const Parameters& parameters) {
  DrivenRobot driven;
  if (kind_of(description, parameters.kind) == MachineKind::kOnLegs) {
    driven.limits = limits_of(parameters.leg_control);
    driven.outline = walking_outline(read_legs(description, parameters.robot, parameters.legs), driven.limits,
                                     std::min(driven.limits.forward, parameters.navigate.speed));
  } else {
    driven.wheels = parameters.controller;
    driven.limits = limits_of(driven.wheels);
    driven.outline = footprint_of(read_rigid_bodies(description));
  }
  return driven;
}

void set_in_force(DrivenRobot& robot, std::string_view name, double value) {
  for (const Key& key : keys(robot.wheels)) {
    if (key.name != name || !key.group.empty() || !(value >= key.min && value <= key.max)) continue;
    if (auto* const* field = std::get_if<double*>(&key.field)) **field = value;
    if (auto* const* field = std::get_if<std::optional<double>*>(&key.field)) **field = value;
    robot.limits = limits_of(robot.wheels);
  }
}

}  // namespace robot_control::navigation
