#include "bindings/wheeled/offline_estimator.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bindings/layers.h"
#include "bindings/numpy_version.h"
#include "configuration/parameters.h"
#include "configuration/wheeled/calibration_file.h"
#include "signals/names.h"
#include "signals/rotation.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using namespace py::literals;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kSensors = kStateSensorNames.size();

/// Returns a robot with two wheels on one axle, whose middle is base_link.
DriveTrain two_wheels(const DriveTrainParameters& given) {
  DriveTrain robot;
  robot.name = robot.source = "wheel_radius and wheel_base";
  robot.base_link = "base_link";
  robot.wheel_base = given.wheel_base.value();
  robot.wheel_base_multiplier = given.wheel_base_multiplier.value_or(1);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const bool left = side == Side::kLeft;
    const double y = (left ? 1 : -1) * robot.wheel_base / 2;
    robot.wheels.push_back({.joint = robot.joints.size(),
                            .centre_base = {0, y, 0},
                            .radius = given.wheel_radius.value(),
                            .sign = 1,
                            .side = side});
    robot.joints.push_back({.name = left ? "left_wheel_joint" : "right_wheel_joint",
                            .child_link = left ? "left_wheel" : "right_wheel",
                            .velocity_limit = given.wheel_velocity_limit.value_or(0),
                            .role = JointRole::kDriven});
  }
  const auto [roll, pitch, yaw] = given.imu_orientation.value_or(Vector3{});
  const Eigen::Quaterniond turn = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  robot.imu_in_base = {.position = given.imu_position.value_or(Vector3{}),
                       .orientation = {turn.x(), turn.y(), turn.z(), turn.w()}};
  return robot;
}

Vector3 roll_pitch_yaw(const Quaternion& q) noexcept {
  return {roll_of(q), pitch_of(q), yaw_of(q)};
}

template <class Values, class Cell>
void copy(const Values& values, std::size_t count, Cell* to) noexcept {
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<Cell>(values[i]);
}

/// An array that is filled row by row; `shape` is that of one row.
template <class Cell>
class Output {
 public:
  using Fill = void (*)(const StateFrame& state, Cell* to);

  Output(const char* name, std::vector<py::ssize_t> shape, py::ssize_t rows, Fill fill)
      : name_(name), width_(1), fill_(fill) {
    for (const py::ssize_t size : shape) width_ *= size;
    shape.insert(shape.begin(), rows);
    array_ = py::array_t<Cell>(shape);
    next_ = array_.mutable_data();
  }

  void add(const StateFrame& state) noexcept {
    fill_(state, next_);
    next_ += width_;
  }
  void give(py::dict& to) const { to[name_] = array_; }

 private:
  const char* name_;
  py::ssize_t width_;
  Fill fill_;
  py::array_t<Cell> array_;
  Cell* next_;
};

using Numbers = std::vector<Output<double>>;
using Counts = std::vector<Output<std::int64_t>>;
using S = StateFrame;

Numbers all_numbers(py::ssize_t rows, bool covariance) {
  Numbers all;
  const auto add = [&](const char* name, std::vector<py::ssize_t> shape, Output<double>::Fill fill) {
    all.emplace_back(name, std::move(shape), rows, fill);
  };
  constexpr auto kCount = static_cast<py::ssize_t>(kSensors);
  add("x", {}, [](const S& s, double* cell) { *cell = s.base.pose_odom.position[0]; });
  add("y", {}, [](const S& s, double* cell) { *cell = s.base.pose_odom.position[1]; });
  add("z", {}, [](const S& s, double* cell) { *cell = s.base.pose_odom.position[2]; });
  add("roll", {}, [](const S& s, double* cell) { *cell = roll_pitch_yaw(s.base.pose_odom.orientation)[0]; });
  add("pitch", {}, [](const S& s, double* cell) { *cell = roll_pitch_yaw(s.base.pose_odom.orientation)[1]; });
  add("yaw", {}, [](const S& s, double* cell) { *cell = roll_pitch_yaw(s.base.pose_odom.orientation)[2]; });
  add("quaternion", {4}, [](const S& s, double* cell) { copy(s.base.pose_odom.orientation, 4, cell); });
  add("attitude", {4}, [](const S& s, double* cell) { copy(s.base.attitude, 4, cell); });
  add("linear", {3}, [](const S& s, double* cell) { copy(s.base.twist_base.linear, 3, cell); });
  add("angular", {3}, [](const S& s, double* cell) { copy(s.base.twist_base.angular, 3, cell); });
  add("distance", {}, [](const S& s, double* cell) { *cell = s.base.distance; });
  add("wheel_x", {}, [](const S& s, double* cell) { *cell = s.wheeled.odometry.x; });
  add("wheel_y", {}, [](const S& s, double* cell) { *cell = s.wheeled.odometry.y; });
  add("wheel_yaw", {}, [](const S& s, double* cell) { *cell = s.wheeled.odometry.yaw; });
  add("wheel_linear", {}, [](const S& s, double* cell) { *cell = s.wheeled.odometry.linear; });
  add("wheel_angular", {}, [](const S& s, double* cell) { *cell = s.wheeled.odometry.angular; });
  if (covariance) {
    add("pose_covariance", {6, 6}, [](const S& s, double* cell) { copy(s.base.pose_covariance, 36, cell); });
    add("twist_covariance", {6, 6}, [](const S& s, double* cell) { copy(s.base.twist_covariance, 36, cell); });
    add("attitude_covariance", {3, 3}, [](const S& s, double* cell) { copy(s.base.attitude_covariance, 9, cell); });
  }
  add("gyro_bias", {3}, [](const S& s, double* cell) { copy(s.base.gyro_bias, 3, cell); });
  add("gyro_bias_deviation", {3}, [](const S& s, double* cell) { copy(s.base.gyro_bias_deviation, 3, cell); });
  add("accelerometer_bias", {3}, [](const S& s, double* cell) { copy(s.base.accelerometer_bias, 3, cell); });
  add("radius_ratio", {}, [](const S& s, double* cell) { *cell = s.wheeled.calibration.radius_ratio; });
  add("radius_ratio_deviation", {},
      [](const S& s, double* cell) { *cell = s.wheeled.calibration.radius_ratio_deviation; });
  add("wheel_base_factor", {}, [](const S& s, double* cell) { *cell = s.wheeled.calibration.wheel_base_factor; });
  add("wheel_base_deviation", {}, [](const S& s, double* cell) { *cell = s.wheeled.calibration.wheel_base_deviation; });
  add("residual_level", {}, [](const S& s, double* cell) { *cell = s.wheeled.residual_level; });
  add("confidence", {kCount}, [](const S& s, double* cell) { copy(s.wheeled.confidence, kSensors, cell); });
  add("nis", {kCount}, [](const S& s, double* cell) { copy(s.wheeled.nis, kSensors, cell); });
  return all;
}

Counts all_counts(py::ssize_t rows) {
  Counts all;
  const auto add = [&](const char* name, std::vector<py::ssize_t> shape, Output<std::int64_t>::Fill fill) {
    all.emplace_back(name, std::move(shape), rows, fill);
  };
  constexpr auto kCount = static_cast<py::ssize_t>(kSensors);
  add("rejected", {kCount}, [](const S& s, std::int64_t* cell) { copy(s.wheeled.rejected, kSensors, cell); });
  add("flags", {}, [](const S& s, std::int64_t* cell) { *cell = static_cast<std::int64_t>(s.base.flags); });
  add("slip", {}, [](const S& s, std::int64_t* cell) { *cell = static_cast<std::int64_t>(s.wheeled.slip); });
  add("degraded", {}, [](const S& s, std::int64_t* cell) { *cell = static_cast<std::int64_t>(s.base.degraded); });
  return all;
}

/// A Mark keeps its flag true while it lives.
class Mark {
 public:
  explicit Mark(bool& flag) noexcept : flag_(flag) { flag_ = true; }
  ~Mark() { flag_ = false; }
  Mark(const Mark&) = delete;
  Mark& operator=(const Mark&) = delete;

 private:
  bool& flag_;
};

}  // namespace

struct OfflineEstimator::Rows {
  struct Table {
    const double* data;
    py::ssize_t rows, columns;

    explicit Table(const Array& array)
        : data(array.data()), rows(array.shape(0)), columns(array.ndim() > 1 ? array.shape(1) : 1) {}
    const double* row(py::ssize_t index) const noexcept { return data + index * columns; }
  };
  Table time, left, right, gyro, accel;
};

OfflineEstimator::OfflineEstimator(const std::string& path, const LayerValues& values, bool use_two_wheels) {
  check_numpy_version();
  const Parameters parameters = read_layers(path, values, "Estimator");
  robot_ = use_two_wheels ? two_wheels(parameters.robot)
                          : read_drive_train(load_description(parameters.urdf), parameters.robot);
  given_ = parameters_ = parameters.estimator;
  if (!parameters.calibration_file.empty()) {
    const auto kept = read_calibration(parameters.calibration_file, robot_, given_);
    if (kept) parameters_ = continued(given_, *kept);
  }
  loop_period_ = parameters.loop.period();
  begin(loop_period_);
}

void OfflineEstimator::save_calibration(const std::string& path) const {
  if (busy_) throw std::runtime_error("another thread is inside process() of this Estimator");
  const LearnedCalibration now = learned(state_);
  if (!began_ || (state_.base.flags & kStateValid) == 0)
    throw std::runtime_error("no calibration: nothing was estimated yet");
  if (!may_be_kept(now)) {
    throw std::runtime_error(
        "no calibration: nothing of it was learned, or it is beyond its bounds; look at the wheels");
  }
  write_calibration(path, now, robot_, given_);
}

void OfflineEstimator::begin(double period) {
  if (busy_) throw std::runtime_error("another thread is inside process() of this Estimator");
  estimator_ = std::make_unique<Estimator>(parameters_, robot_, period);
  estimator_->enter_run();
  period_ = period;
  sensors_ = {};
  sensors_.head.run = 1;
  sensors_.driver_state = DriverState::kRunning;
  sensors_.joint_count = robot_.joints.size();
  for (JointSample& joint : sensors_.joints) joint.velocity = joint.effort = kNaN;
  began_ = false;
}

void OfflineEstimator::sense(const Rows& rows, py::ssize_t row) noexcept {
  sensors_.valid = 0;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const Rows::Table& angles = side == Side::kLeft ? rows.left : rows.right;
    const double* angle = angles.row(row);
    double sign = 0;
    for (const WheelModel& wheel : robot_.wheels) {
      if (wheel.side != side) continue;
      if (sign == 0 || angles.columns > 1) sign = wheel.sign;
      sensors_.joints[wheel.joint].position = *angle * sign * wheel.sign;
      sensors_.joints[wheel.joint].valid = std::isnan(*angle) ? 0U : std::uint32_t{kValidPosition};
      if (angles.columns > 1) ++angle;
    }
  }
  const auto read = [&](const Rows::Table& table, SensorValidity bit, Vector3& to) {
    to = {};
    if (table.rows == 0) return;
    copy(table.row(row), 3, to.data());
    if (!std::isnan(to[0]) || !std::isnan(to[1]) || !std::isnan(to[2])) sensors_.valid |= bit;
  };
  read(rows.gyro, kValidGyro, sensors_.imu.angular_velocity);
  read(rows.accel, kValidAccelerometer, sensors_.imu.linear_acceleration);
}

double OfflineEstimator::since_last(double time, double rounding) const noexcept {
  if (!began_) return period_;
  const double dt = time - last_time_;
  const double periods = std::max(1.0, std::round(dt / period_));
  return std::abs(dt - periods * period_) <= rounding ? periods * period_ : dt;
}

py::dict OfflineEstimator::process(const Array& time, const Array& left, const Array& right, const Array& gyro,
                                   const Array& accel, double rounding, py::ssize_t every, bool covariance,
                                   const std::optional<Vector3>& pose) {
  constexpr py::ssize_t kBlock = 100000;  // rows between two checks for Ctrl-C
  if (busy_) throw std::runtime_error("another thread is inside process() of this Estimator");
  const Mark mark(busy_);
  if (pose) estimator_->set_pose(*pose);
  const Rows rows{Rows::Table(time), Rows::Table(left), Rows::Table(right), Rows::Table(gyro), Rows::Table(accel)};
  const py::ssize_t count = rows.time.rows;
  const py::ssize_t outputs = count == 0 ? 0 : 1 + (count - 1 + every - 1) / every;

  py::array_t<double> times(outputs);
  double* next_time = times.mutable_data();
  Numbers numbers = all_numbers(outputs, covariance);
  Counts counts = all_counts(outputs);

  const auto step = [&](py::ssize_t row) {
    const double now = rows.time.data[row];
    sense(rows, row);
    sensors_.head.stamp_ns = std::llround(now * 1.0e9);
    estimator_->step(sensors_, since_last(now, rounding), state_);
    ++sensors_.head.cycle;
    last_time_ = now;
    began_ = true;
    if (row % every != 0 && row != count - 1) return;
    *next_time++ = now;
    for (auto& output : numbers) output.add(state_);
    for (auto& output : counts) output.add(state_);
  };
  for (py::ssize_t first = 0; first < count; first += kBlock) {
    {
      const py::gil_scoped_release release;
      for (py::ssize_t row = first; row < std::min(first + kBlock, count); ++row) step(row);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

  py::dict result;
  result["time"] = times;
  for (const auto& output : numbers) output.give(result);
  for (const auto& output : counts) output.give(result);
  return result;
}

py::dict OfflineEstimator::describe() const {
  py::list wheels;
  for (const WheelModel& wheel : robot_.wheels) {
    wheels.append(py::dict("joint"_a = robot_.joints.at(wheel.joint).name,
                           "side"_a = wheel.side == Side::kLeft ? "left" : "right", "sign"_a = wheel.sign,
                           "centre"_a = wheel.centre_base, "radius"_a = wheel.radius));
  }
  return py::dict("name"_a = robot_.name, "source"_a = robot_.source, "base_link"_a = robot_.base_link,
                  "wheel_base"_a = robot_.wheel_base, "wheel_base_multiplier"_a = robot_.wheel_base_multiplier,
                  "effective_wheel_base"_a = robot_.effective_wheel_base(), "wheels"_a = wheels,
                  "imu"_a = py::dict("link"_a = robot_.imu_link, "position"_a = robot_.imu_in_base.position,
                                     "orientation"_a = robot_.imu_in_base.orientation));
}

void bind_offline_estimator(py::module_& module) {
  py::class_<OfflineEstimator>(module, "OfflineEstimator")
      .def(py::init<const std::string&, const LayerValues&, bool>(), "path"_a, "values"_a, "two_wheels"_a)
      .def("begin", &OfflineEstimator::begin, "period"_a)
      .def("process", &OfflineEstimator::process, "time"_a, "left"_a, "right"_a, "gyro"_a, "accel"_a, py::kw_only(),
           "rounding"_a, "every"_a, "covariance"_a, "pose"_a)
      .def("save_calibration", &OfflineEstimator::save_calibration, "path"_a)
      .def_property_readonly("period", &OfflineEstimator::period)
      .def_property_readonly("loop_period", &OfflineEstimator::loop_period)
      .def_property_readonly("last_time", &OfflineEstimator::last_time)
      .def_property_readonly("robot", &OfflineEstimator::describe);
}

}  // namespace robot_control
