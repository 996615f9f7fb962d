#include "bindings/recorder.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "machine/machine_model.h"

namespace py = pybind11;

namespace robot_control {
namespace {

/// Reads one number of a row; `index` is that of the wheel or the axis.
using Cell = double (*)(const DriverTrace& row, std::size_t index);

/// An array that is filled row by row.
class Recorded {
 public:
  Recorded(const char* name, py::ssize_t cycles, std::size_t width, Cell cell)
      : name_(name),
        array_({cycles, static_cast<py::ssize_t>(width)}),
        next_(array_.mutable_data()),
        width_(width),
        cell_(cell) {}

  void add(const DriverTrace& row) {
    for (std::size_t index = 0; index < width_; ++index) *next_++ = cell_(row, index);
  }
  void give(py::dict& to) const { to[name_] = array_; }

 private:
  const char* name_;
  py::array_t<double> array_;
  double* next_;
  std::size_t width_;
  Cell cell_;
};

std::vector<Recorded> all_recorded(py::ssize_t cycles, std::size_t wheels) {
  using D = DriverTrace;
  using I = std::size_t;
  std::vector<Recorded> all;
  const auto add = [&](const char* name, I width, Cell cell) { all.emplace_back(name, cycles, width, cell); };
  add("wheel_position", wheels, [](const D& row, I i) { return row.sensors.joints[i].position; });
  add("gyro", 3, [](const D& row, I i) { return row.sensors.imu.angular_velocity[i]; });
  add("accel", 3, [](const D& row, I i) { return row.sensors.imu.linear_acceleration[i]; });
  add("position", 3, [](const D& row, I i) { return row.truth.pose_world.position[i]; });
  add("orientation", 4, [](const D& row, I i) { return row.truth.pose_world.orientation[i]; });
  add("linear", 3, [](const D& row, I i) { return row.truth.twist_base.linear[i]; });
  add("angular", 3, [](const D& row, I i) { return row.truth.twist_base.angular[i]; });
  add("wheel_speed", wheels, [](const D& row, I i) { return row.truth.joints[i].velocity; });
  add("slip", wheels, [](const D& row, I i) { return row.truth.slip[i]; });
  add("load", wheels, [](const D& row, I i) { return row.truth.normal_force[i]; });
  return all;
}

}  // namespace

py::dict record(ClosedLoop& loop, const py::array_t<double>& commands) {
  if (commands.ndim() != 2 || commands.shape(1) != 2) {
    throw std::invalid_argument("commands must have the shape (cycles, 2): linear m/s, angular rad/s of every cycle");
  }
  constexpr py::ssize_t kBlock = 10000;  // cycles between two checks for Ctrl-C
  const py::ssize_t cycles = commands.shape(0);
  const auto command = commands.unchecked<2>();
  std::vector<Recorded> recorded = all_recorded(cycles, driven_joint_indices(loop.robot().machine()).size());
  py::array_t<double> time(cycles), stopped(cycles);
  for (py::ssize_t row = 0; row < cycles; ++row) {
    if (std::isfinite(command(row, 0))) {
      loop.command({.linear = {command(row, 0), 0, 0}, .angular = {0, 0, command(row, 1)}});
    }
    loop.step();
    const JoinedRow& now = loop.row();
    for (Recorded& each : recorded) each.add(*now.driver);
    time.mutable_at(row) = now.time;
    stopped.mutable_at(row) = now.monitor == nullptr || now.monitor->permit.action == PermitAction::kBrake;
    if (row % kBlock == 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  py::dict log;
  log["time"] = time;
  log["stopped"] = stopped;
  for (const Recorded& each : recorded) each.give(log);
  return log;
}

}  // namespace robot_control
