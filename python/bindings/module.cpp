/// This is the extension module behind robot_control.ClosedLoop. The Python package documents shapes, units and
/// defaults.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "bindings/columns.h"
#include "bindings/describe.h"
#include "bindings/layers.h"
#include "bindings/legs.h"
#include "bindings/log_replay.h"
#include "bindings/loop_bindings.h"
#include "bindings/loop_replay.h"
#include "bindings/run_bag.h"
#include "bindings/signal_names.h"
#include "bindings/wheeled/offline_estimator.h"
#include "bindings/wheeled/wheel_loops.h"
#include "control/wheeled/limits/drive_limits.h"
#include "control/wheeled/wheel_loops/wheel_loop_stability.h"
#include "drivers/driver.h"
#include "drivers/mujoco/model/mujoco_model.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/gravity.h"
#include "machine/legs/leg_model.h"
#include "robots/robot_kind.h"
#include "robots/wheeled/start_check.h"
#include "signals/wheeled/slip_detection.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using namespace py::literals;

DriveTrain robot_of(const Parameters& parameters) {
  return read_drive_train(load_description(parameters.urdf), parameters.robot);
}

/// Returns the machine as a loop of these parameters has it.
std::unique_ptr<MachineModel> machine_of(const Parameters& parameters) {
  const RobotDescription description = load_description(parameters.urdf);
  return read_robot(description, limited_by_drives(parameters, description));
}

/// Returns the machine as described: without the errors of the field, which add a load beside its centre of gravity.
MujocoPlantParameters without_errors(MujocoPlantParameters parameters) {
  parameters.sensor_errors = ErrorLevel::kIdeal;
  return parameters;
}

/// Starts a loop with the robot in the scene. Returns how far it leans at rest in rad, and the share of its weight on
/// the drive wheels, or on the legs. `unloaded` names the drive wheels that carry nothing, and the bodies that touch
/// the ground instead. Throws what the start of a loop throws.
py::dict stand(Parameters parameters) {
  parameters.plant = without_errors(parameters.plant);
  ClosedLoop loop(parameters);
  loop.step();
  const TruthFrame& truth = loop.row().driver->truth;
  const double load = std::accumulate(truth.normal_force.begin(), truth.normal_force.end(), 0.0);
  const Quaternion& q = truth.pose_world.orientation;
  const double mass = total_mass(*loop.robot().machine().bodies) + parameters.plant.payload;
  return py::dict("lean"_a = 2 * std::asin(std::min(1.0, std::hypot(q[0], q[1]))),
                  "carried"_a = load / (mass * kGravity), "unloaded"_a = loop.warning());
}

py::dict controller_parameters(const Parameters& parameters) {
  const SpeedLimits limits = speed_limits(parameters.controller);
  const auto axis = [](const MotionLimits& axis_limits) {
    return py::dict("speed"_a = axis_limits.speed, "acceleration"_a = axis_limits.acceleration,
                    "deceleration"_a = axis_limits.deceleration, "jerk"_a = axis_limits.jerk);
  };
  return py::dict("linear"_a = axis(limits.linear), "angular"_a = axis(limits.angular),
                  "cmd_vel_timeout"_a = parameters.controller.cmd_vel_timeout, "rate"_a = parameters.loop.rate,
                  "lockstep"_a = parameters.loop.clock == ClockMode::kLockstep);
}

py::list derived_wheel_loops(Parameters parameters) {
  parameters.controller.pid_kp.reset();
  parameters.controller.pid_ki.reset();
  parameters.controller.pid_kd = 0;
  return wheel_loops(parameters, robot_of(parameters));
}

/// Binds the functions that take a parameter file and values laid over it.
void bind_parameters(py::module_& module) {
  const auto define = [&](const char* name, auto function) {
    module.def(
        name,
        [function](const std::string& path, const LayerValues& values) {
          return function(parameters_from(path, values));
        },
        "path"_a, "values"_a);
  };
  define("describe", [](const Parameters& parameters) { return describe(*machine_of(parameters)); });
  define("mjcf", [](const Parameters& parameters) {
    return exported_mjcf(*machine_of(parameters), without_errors(parameters.plant), parameters.loop.period());
  });
  define("stand", stand);
  define("legs", [](const Parameters& parameters) {
    return read_legs(load_description(parameters.urdf), parameters.robot, parameters.legs);
  });
  define("wheel_loops", [](const Parameters& parameters) { return wheel_loops(parameters, robot_of(parameters)); });
  define("derived_wheel_loops", derived_wheel_loops);
  define("controller_parameters", controller_parameters);
}

void bind_spectral_radius(py::module_& module) {
  module.def(
      "spectral_radius",
      [](double kp, double ki, double kd, double model_inertia, double inertia, double damping, double period,
         double bandwidth, unsigned delay) {
        return wheel_loop_spectral_radius({.kp = kp, .ki = ki, .kd = kd, .model_inertia = model_inertia},
                                          {.inertia = inertia, .damping = damping}, period, bandwidth, delay);
      },
      py::kw_only(), "kp"_a, "ki"_a, "kd"_a, "model_inertia"_a, "inertia"_a, "damping"_a, "period"_a, "bandwidth"_a,
      "delay"_a = 0);
}

}  // namespace
}  // namespace robot_control

PYBIND11_MODULE(_robot_control, module) {
  using namespace robot_control;
  py::register_exception<ParameterError>(module, "ParameterError", PyExc_ValueError);
  py::register_exception<RobotError>(module, "RobotError", PyExc_ValueError);
  py::register_exception<DriverError>(module, "DriverError", PyExc_RuntimeError);
  module.attr("signal_names") = signal_names();
  module.def("slip_detection", &slip_detection, "residual_level"_a);
  module.attr("project_folder") = ROBOT_CONTROL_PROJECT;  // folder of the checkout, where PyPI's packages are installed
  bind_legs(module);
  bind_parameters(module);
  bind_spectral_radius(module);
  bind_offline_estimator(module);
  bind_loop_replay(module);
  bind_log_replay(module);
  bind_columns(module);
  bind_closed_loop(module);
  bind_closed_loops(module);
  bind_run_bag(module);
}
