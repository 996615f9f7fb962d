#pragma once
/// Converts the wheels' travel to the motion of base_link. Wheels behind each other turn the robot about their middle.
///
///   distance = (right + left) / 2        turn = (right − left) / wheel_base
///   forward  = distance + turn · axle.y  left = −turn · axle.x
///
/// wheel_base is the effective one (DriveTrain), and left and right are the means of a side.

#include "estimation/wheeled/wheels/arc.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

struct WheelGeometry {
  double wheel_base = 1;  ///< m, effective
  Vector3 axle{};         ///< m, middle of the axles in base axes

  explicit WheelGeometry(const DriveTrain& robot) noexcept
      : wheel_base(robot.effective_wheel_base()), axle(middle_of_axles(robot)) {}

  double turn(double left, double right) const noexcept { return (right - left) / wheel_base; }

  /// Converts travel (m, rad) as well as speed (m/s, rad/s).
  Motion base_motion(double distance, double turn) const noexcept {
    return {distance + turn * axle[1], -turn * axle[0], turn};
  }
};

}  // namespace robot_control
