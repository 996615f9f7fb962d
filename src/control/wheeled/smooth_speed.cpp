#include "control/wheeled/smooth_speed.h"

#include <algorithm>
#include <cmath>

#include "control/wheeled/measured_robot.h"
#include "control/wheeled/wheel_loops/feed_forward.h"
#include "control/wheeled/wheel_loops/ground_friction.h"
#include "control/wheeled/wheel_loops/wheel_loop_gains.h"

namespace robot_control {

double smooth_speed(const DriveControllerParameters& parameters, const DriveTrain& robot, double quantum,
                    double period) {
  const DriveTrain measured = measured_robot(robot, parameters.feed_forward);
  const double hidden = quantum + (GroundFriction(measured).scrubs() ? kTread : 0);
  double fastest = 0;
  for (const WheelModel& wheel : measured.wheels) {
    const double inertia = std::min(straight_inertia(measured, wheel), turning_inertia(measured, wheel));
    const double ki = wheel_loop_gains(parameters, measured, wheel, period).ki;
    fastest = std::max(fastest, wheel.radius * std::sqrt(27.0 / 6.0 * ki / inertia) * hidden);
  }
  return fastest;
}

}  // namespace robot_control
