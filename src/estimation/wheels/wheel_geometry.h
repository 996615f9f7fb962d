#pragma once
/// Converts the wheels' travel to the motion of base_link. Wheels behind each other turn the robot about their middle.
///
///   distance = (right + left) / 2        turn = (right − left) / wheel_base
///   forward  = distance + turn · axle_y  left = −turn · axle_x
///
/// wheel_base is the effective one (DriveTrain), and left and right are the means of a side. The point (axle_x, axle_y)
/// is the middle of the wheels in base axes. `ground` is the height of the contacts.

#include "estimation/wheels/arc.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

struct WheelGeometry {
  double wheel_base = 1;  ///< m, effective
  double axle_x = 0;      ///< m
  double axle_y = 0;      ///< m
  double ground = 0;      ///< m

  explicit WheelGeometry(const DriveTrain& robot) noexcept
      : wheel_base(robot.effective_wheel_base()),
        axle_x(middle_of_axles(robot)[0]),
        axle_y(middle_of_axles(robot)[1]),
        ground(middle_of_axles(robot)[2]) {
    for (const WheelModel& wheel : robot.wheels) ground -= wheel.radius / static_cast<double>(robot.wheels.size());
  }

  double turn(double left, double right) const noexcept { return (right - left) / wheel_base; }

  /// Converts travel (m, rad) as well as speed (m/s, rad/s).
  Motion base_motion(double distance, double turn) const noexcept {
    return {distance + turn * axle_y, -turn * axle_x, turn};
  }
};

}  // namespace robot_control
