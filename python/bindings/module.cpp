/// This is the extension module behind robot_control.ClosedLoop. The Python package documents shapes, units and
/// defaults.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "bindings/describe.h"
#include "bindings/layers.h"
#include "bindings/legs.h"
#include "bindings/log_replay.h"
#include "bindings/loop_replay.h"
#include "bindings/numpy_version.h"
#include "bindings/recorder.h"
#include "bindings/run_bag.h"
#include "bindings/signal_names.h"
#include "bindings/wheeled/offline_estimator.h"
#include "bindings/wheeled/wheel_loops.h"
#include "control/common/limits/stop_distance.h"
#include "control/legged/walk/gait.h"
#include "control/legged/walk/own_gaits.h"
#include "control/legged/walk/twist_limiter.h"
#include "control/wheeled/limits/drive_limits.h"
#include "control/wheeled/smooth_speed.h"
#include "control/wheeled/wheel_loops/wheel_loop_stability.h"
#include "drivers/driver.h"
#include "drivers/mujoco/model/mujoco_model.h"
#include "log/fields/trace_fields.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/gravity.h"
#include "machine/legs/leg_model.h"
#include "robots/robot_kind.h"
#include "robots/wheeled/start_check.h"
#include "signals/names.h"
#include "signals/robot_kinds.h"
#include "signals/wheeled/slip_detection.h"
#include "simulation/closed_loop.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using namespace py::literals;

Twist planar(double linear, double lateral, double angular) {
  return {.linear = {linear, lateral, 0}, .angular = {0, 0, angular}};
}

std::vector<TraceColumn> columns_of(const ClosedLoop& loop) {
  const MachineModel& machine = loop.robot().machine();
  std::vector<std::string> names;
  for (const JointModel& joint : machine.joints) names.push_back(joint.name);
  return log_columns(names, machine.contacts, false);
}

/// Passes the result of a command function to the loop as a command that arrives now.
void receive(ClosedLoop& loop, const py::object& given) {
  std::vector<double> numbers;
  try {
    numbers = given.cast<std::vector<double>>();
  } catch (const py::cast_error&) {
    numbers.clear();
  }
  if (numbers.size() == 2) return loop.command(planar(numbers[0], 0, numbers[1]));
  if (numbers.size() == 3) return loop.command(planar(numbers[0], numbers[1], numbers[2]));
  throw py::type_error(
      "command must give (linear, angular), two numbers in m/s and rad/s, or (linear, lateral, "
      "angular); it gave " +
      std::string(py::repr(given)));
}

/// Runs `cycles` cycles. `command(t)` returns (linear, angular) or (linear, lateral, angular), or is None. Other Python
/// threads run meanwhile if no command function needs the interpreter. `replay` stores the cycles, or is None.
py::dict run(ClosedLoop& loop, std::int64_t cycles, const py::object& command, LoopReplay* replay) {
  constexpr std::int64_t kBlock = 1000;  // cycles between two checks for Ctrl-C
  if (cycles < 0) throw py::value_error("cycles must not be negative");
  const std::vector<TraceColumn> columns = columns_of(loop);
  std::vector<py::array_t<double>> arrays;
  std::vector<double*> cells;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    arrays.emplace_back(cycles);
    cells.push_back(arrays.back().mutable_data());
  }
  const auto step = [&](std::int64_t row) {
    loop.step();
    if (replay != nullptr) replay->store(loop);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      cells[i][row] = columns[i].value(loop.row(), columns[i].element);
    }
  };
  for (std::int64_t first = 0; first < cycles; first += kBlock) {
    const std::int64_t last = std::min(first + kBlock, cycles);
    if (command.is_none()) {
      const py::gil_scoped_release release;
      for (std::int64_t row = first; row < last; ++row) step(row);
    } else {
      for (std::int64_t row = first; row < last; ++row) {
        receive(loop, command(loop.time()));
        step(row);
      }
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  py::dict log;
  for (std::size_t i = 0; i < columns.size(); ++i) log[py::str(columns[i].name)] = arrays[i];
  return log;
}

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

Parameters parameters_from(const std::string& path, const LayerValues& values) {
  Parameters parameters = read_layers(path, values, "ClosedLoop");
  for (const std::string& text : parameters.warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
  }
  return parameters;
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

py::dict scan_of(const ClosedLoop& loop) {
  const LaserScan scan = loop.scan();
  if (scan.ranges.empty()) throw py::value_error("there is no laser: set laser.rate of the simulated machine");
  return py::dict("cycle"_a = scan.head.cycle, "stamp_ns"_a = scan.head.stamp_ns, "link"_a = scan.link,
                  "angle_min"_a = scan.angle_min, "angle_increment"_a = scan.angle_increment,
                  "range_min"_a = scan.range_min, "range_max"_a = scan.range_max,
                  "ranges"_a = py::array_t<float>(static_cast<py::ssize_t>(scan.ranges.size()), scan.ranges.data()));
}

/// Returns the distance in m of a ramp from `speed`, including the cycle before it begins.
double distance_to_stop(const ClosedLoop& loop, double speed, bool emergency) {
  const Parameters& parameters = loop.parameters();
  if (loop.robot().kind() == kLeggedKind)
    return walking_stop_distance(parameters.leg_control, leg_model_of(loop.robot().machine()).leg_length(), speed,
                                 emergency);
  const MotionLimits limits = speed_limits(parameters.controller).linear;
  const double deceleration = emergency ? limits.emergency_deceleration : limits.deceleration_from(speed);
  return stop_distance(speed, deceleration, limits.jerk) + std::abs(speed) * parameters.loop.period();
}

double smooth_speed_of(const ClosedLoop& loop) {
  const Parameters& parameters = loop.parameters();
  return smooth_speed(parameters.controller, drive_train_of(loop.robot().machine()),
                      encoder_count(parameters.estimator), parameters.loop.period());
}

std::vector<std::pair<std::string, std::string>> column_meanings(const ClosedLoop& loop) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const TraceColumn& column : columns_of(loop)) names.emplace_back(column.name, column.meaning);
  return names;
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

using ModeNumbers = std::array<std::uint64_t, 2>;  // kind and index

Mode mode_of(const ModeNumbers& numbers) {
  return {static_cast<ModeKind>(numbers[0]), numbers[1]};
}

void bind_closed_loop(py::module_& module) {
  py::class_<ClosedLoop>(module, "ClosedLoop")
      .def(py::init([](const std::string& path, const LayerValues& values) {
             check_numpy_version();
             return std::make_unique<ClosedLoop>(parameters_from(path, values));
           }),
           "path"_a, "values"_a)
      .def(
          "command",
          [](ClosedLoop& loop, double linear, double angular, double lateral) {
            loop.command(planar(linear, lateral, angular));
          },
          "linear"_a, "angular"_a, "lateral"_a = 0.0)
      .def(
          "choose_mode", [](ClosedLoop& loop, const ModeNumbers& mode) { loop.choose_mode(mode_of(mode)); }, "mode"_a)
      .def(
          "request",
          [](ClosedLoop& loop, const std::array<double, 6>& pose, const ModeNumbers& mode,
             const std::array<double, kRequestJoints>& joints) {
            const auto& [x, y, height, roll, pitch, yaw] = pose;
            loop.request({.twist = {},
                          .posture = {.height = height, .roll = roll, .pitch = pitch, .x = x, .y = y, .yaw = yaw},
                          .mode = mode_of(mode),
                          .joints = joints});
          },
          "pose"_a, "mode"_a, "joints"_a)
      .def("e_stop", &ClosedLoop::e_stop)
      .def("e_stop_reset", &ClosedLoop::e_stop_reset)
      .def("heartbeat", &ClosedLoop::heartbeat)
      .def("clearance", &ClosedLoop::clearance, "metres"_a)
      .def("reset", &ClosedLoop::reset)
      .def("set_parameters", &ClosedLoop::set_parameters, "request"_a)
      .def("inject_fault", &ClosedLoop::inject_fault, "component"_a, "kind"_a)
      .def("run", &run, "cycles"_a, "command"_a, "replay"_a = nullptr)
      .def("record", &record, "commands"_a)
      .def("scan", &scan_of)
      .def("stop_distance", &distance_to_stop, "speed"_a, "emergency"_a)
      .def_property_readonly("smooth_speed", &smooth_speed_of)
      .def_property_readonly("period", [](const ClosedLoop& loop) { return loop.parameters().loop.period(); })
      .def_property_readonly("robot", [](const ClosedLoop& loop) { return describe(loop.robot().machine()); })
      .def_property_readonly(
          "gaits", [](const ClosedLoop& loop) { return gait_words(all_gaits(loop.parameters().leg_control.gaits)); })
      .def_property_readonly("cycle", &ClosedLoop::cycle)
      .def_property_readonly("time", &ClosedLoop::time)
      .def_property_readonly("columns", &column_meanings);
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
  bind_closed_loop(module);
  bind_run_bag(module);
}
