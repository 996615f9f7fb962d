#include "bindings/wheeled/wheel_loops.h"

#include <algorithm>

#include "control/wheeled/measured_robot.h"
#include "control/wheeled/wheel_loops/feed_forward.h"
#include "control/wheeled/wheel_loops/wheel_loop_gains.h"
#include "machine/wheeled/scrub.h"

namespace py = pybind11;

namespace robot_control {

py::list wheel_loops(const Parameters& parameters, const DriveTrain& robot) {
  using namespace py::literals;
  const double period = parameters.loop.period();
  const DriveTrain measured = measured_robot(robot, parameters.controller.feed_forward);
  const Scrub scrub(measured);
  py::list loops;
  for (std::size_t i = 0; i < measured.wheels.size(); ++i) {
    const WheelModel& wheel = measured.wheels[i];
    const JointModel& joint = measured.joints.at(wheel.joint);
    const WheelLoopGains gains = wheel_loop_gains(parameters.controller, measured, wheel, period);
    loops.append(py::dict(
        "joint"_a = joint.name, "side"_a = wheel.side == Side::kLeft ? "left" : "right", "sign"_a = wheel.sign,
        "radius"_a = wheel.radius, "wheels_beside"_a = std::ranges::count(robot.wheels, wheel.side, &WheelModel::side),
        "effort_limit"_a = joint.effort_limit, "velocity_limit"_a = joint.velocity_limit, "damping"_a = joint.damping,
        "friction"_a = joint.friction, "lifted"_a = wheel.inertia, "turning"_a = turning_inertia(measured, wheel),
        "straight"_a = straight_inertia(measured, wheel), "scrub"_a = scrub.max_effort(i), "kp"_a = gains.kp,
        "ki"_a = gains.ki, "kd"_a = gains.kd, "model_inertia"_a = gains.model_inertia,
        "bandwidth"_a = tracking_bandwidth(parameters.controller, period), "period"_a = period));
  }
  return loops;
}

}  // namespace robot_control
