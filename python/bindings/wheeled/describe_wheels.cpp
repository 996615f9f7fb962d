#include "bindings/wheeled/describe_wheels.h"

#include <pybind11/stl.h>

#include "machine/wheeled/drive_train.h"

namespace py = pybind11;

namespace robot_control {
namespace {

py::dict wheel_dict(const DriveTrain& robot, const WheelModel& wheel) {
  using namespace py::literals;
  return py::dict("joint"_a = robot.joints.at(wheel.joint).name, "centre"_a = wheel.centre_base,
                  "radius"_a = wheel.radius, "width"_a = wheel.width, "inertia"_a = wheel.inertia,
                  "rotor_inertia"_a = wheel.rotor_inertia);
}

}  // namespace

void describe_wheels(const MachineModel& machine, py::dict& result) {
  const DriveTrain& robot = drive_train_of(machine);
  py::list wheels, casters;
  for (const WheelModel& wheel : robot.wheels) {
    py::dict entry = wheel_dict(robot, wheel);
    entry["side"] = wheel.side == Side::kLeft ? "left" : "right";
    entry["sign"] = wheel.sign;
    wheels.append(entry);
  }
  for (const WheelModel& caster : robot.casters) casters.append(wheel_dict(robot, caster));
  result["yaw_inertia"] = robot.yaw_inertia;
  result["wheel_base"] = robot.wheel_base;
  result["wheel_base_multiplier"] = robot.wheel_base_multiplier;
  result["effective_wheel_base"] = robot.effective_wheel_base();
  result["wheels"] = wheels;
  result["casters"] = casters;
}

}  // namespace robot_control
