#pragma once
/// From wheel travel to the motion of base_link, for two driven wheels on one axle line.
///
///   distance = (right + left) / 2        turn = (right − left) / wheel_base
///   forward  = distance + turn · axle_y  left = −turn · axle_x
///
/// (axle_x, axle_y) is the middle of the axle in base axes: rigid-body motion of a point beside the axle.

#include "estimation/arc.h"
#include "robot/robot_model.h"

namespace robot_control {

struct WheelGeometry {
  double wheel_base = 1;  ///< m
  double axle_x = 0;      ///< m
  double axle_y = 0;      ///< m

  explicit WheelGeometry(const RobotModel& robot) noexcept
      : wheel_base(robot.wheel_base),
        axle_x((robot.left.centre_base[0] + robot.right.centre_base[0]) / 2),
        axle_y((robot.left.centre_base[1] + robot.right.centre_base[1]) / 2) {}

  double turn(double left, double right) const noexcept { return (right - left) / wheel_base; }

  /// Works on travel [m, rad] as on speed [m/s, rad/s].
  Motion base_motion(double distance, double turn) const noexcept {
    return {distance + turn * axle_y, -turn * axle_x, turn};
  }
};

}  // namespace robot_control
