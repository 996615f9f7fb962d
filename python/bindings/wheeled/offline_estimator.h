#pragma once
/// robot_control.Estimator runs the node's law (estimation/wheeled/estimator.h) over recorded samples, row by row.
///
/// A row is a time and the samples taken at that time. These samples are absent:
///   a wheel              if its angle is NaN
///   gyro, accelerometer  if all three axes are NaN, or if it is not given at all: its validity bit is off
/// A sample that is partly NaN, or infinite, is passed to the law unchanged, which refuses it as a bad sample.
///
/// dt of a row is the time since the row before; for the first row it is the period. If dt differs from n periods only
/// by the rounding of its stamps, it is set to n · period exactly. The samples of a node's log therefore give the
/// node's bits. Joint speeds and efforts are not known and set to NaN.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>

#include "bindings/layers.h"
#include "estimation/wheeled/estimator.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

class OfflineEstimator {
 public:
  using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

  /// Reads parameters as ClosedLoop does, and their calibration_file as the node does. With `two_wheels` no URDF is
  /// read: the robot consists of robot.wheel_radius, wheel_base, imu_position and imu_orientation, with base_link in
  /// the middle of the axle. Throws ParameterError, RobotError, std::invalid_argument.
  OfflineEstimator(const std::string& path, const LayerValues& values, bool two_wheels);

  /// Begins a new run with this period [s]. Throws std::invalid_argument.
  void begin(double period);

  /// Runs the law over rows. `time` (N,) is strictly increasing. `left` and `right` have the shape (N, 1) or (N, wheels
  /// of the side). `gyro` and `accel` have the shape (N, 3), or (0, 3) if there is none. `rounding` is the possible
  /// error of the difference of two stamps in s. Every `every`-th row is returned, beginning with the first, and the
  /// last row. `pose` is x [m], y [m], yaw [rad] of the first row, as in set_odometry. The caller has checked all
  /// arguments. Other Python threads run meanwhile.
  pybind11::dict process(const Array& time, const Array& left, const Array& right, const Array& gyro,
                         const Array& accel, double rounding, pybind11::ssize_t every, bool covariance,
                         const std::optional<Vector3>& pose);

  /// Writes the learned calibration as the node does (configuration/wheeled/calibration_file.h). Throws
  /// std::runtime_error if nothing was learned or it is beyond its bounds; throws std::system_error if the file cannot
  /// be written.
  void save_calibration(const std::string& path) const;

  double period() const noexcept { return period_; }            ///< s
  double loop_period() const noexcept { return loop_period_; }  ///< s, of robot.rate
  /// Returns the time of the last row since `begin`, s.
  std::optional<double> last_time() const noexcept { return began_ ? std::optional(last_time_) : std::nullopt; }
  pybind11::dict describe() const;  ///< returns the robot, as documented by the Python class

 private:
  struct Rows;
  void sense(const Rows& rows, pybind11::ssize_t row) noexcept;
  double since_last(double time, double rounding) const noexcept;  ///< s

  EstimatorParameters given_;       ///< the parameters without the calibration of the file
  EstimatorParameters parameters_;  ///< the parameters with which the run begins
  DriveTrain robot_;
  double loop_period_ = 0;
  double period_ = 0;
  std::unique_ptr<Estimator> estimator_;
  SensorFrame sensors_;
  StateFrame state_;
  double last_time_ = 0;
  bool began_ = false;
  bool busy_ = false;  ///< a thread is inside `process`
};

/// Adds the class, and the words of its bits, to the module.
void bind_offline_estimator(pybind11::module_& module);

}  // namespace robot_control
