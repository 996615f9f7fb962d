#pragma once
/// robot_control.Estimator: the node's law (estimation/estimator.h) over recorded samples, one row after the other.
///
/// A row is a time and the samples taken at it. Absent is
///   a wheel              whose angle is NaN; a row without any angle has kValidJoints off
///   gyro, accelerometer  where all three axes are NaN, or which is not given at all: its validity bit is off
/// What is partly NaN, or infinite, is offered to the law as it stands, which refuses it as a bad sample.
///
/// dt of a row is the time since the row before; of the very first one, the period. Where it is a whole number n of
/// periods but for the rounding of its stamps, it is n · period exactly: so the samples of a node's log give the node's
/// bits. Joint speeds and efforts are not given: NaN.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimation/estimator.h"
#include "parameters/parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

class OfflineEstimator {
 public:
  using Values = std::vector<std::pair<std::string, std::string>>;
  using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

  /// Reads parameters as ClosedLoop does, and their calibration_file as the node does. `two_wheels`: no URDF, the robot
  /// is robot.wheel_radius, wheel_base, imu_position, imu_orientation, base_link in the middle of the axle. Throws
  /// ParameterError, RobotError, std::invalid_argument.
  OfflineEstimator(const std::string& path, const Values& values, bool two_wheels);

  /// A new run with this period [s]. Throws std::invalid_argument.
  void begin(double period);

  /// time (N,) strictly increasing, left and right (N, 1) or (N, wheels of the side), gyro and accel (N, 3), or (0, 3)
  /// where there is none. `rounding`: s, by which the difference of two stamps may be wrong. Every `every`-th row comes
  /// out, from the first one on, and the last. `pose`: x [m], y [m], yaw [rad] of the first row, as set_odometry sets
  /// it. The caller has checked all of it. Other Python threads run meanwhile.
  pybind11::dict process(const Array& time, const Array& left, const Array& right, const Array& gyro,
                         const Array& accel, double rounding, pybind11::ssize_t every, bool covariance,
                         const std::optional<Vector3>& pose);

  /// What was learned so far, as the node keeps it (parameters/calibration_file.h). Throws std::runtime_error: nothing
  /// was, or beyond its bounds; std::system_error.
  void save_calibration(const std::string& path) const;

  double period() const noexcept { return period_; }            ///< s
  double loop_period() const noexcept { return loop_period_; }  ///< s, of robot.rate
  /// s, of the last row since `begin`
  std::optional<double> last_time() const noexcept { return began_ ? std::optional(last_time_) : std::nullopt; }
  pybind11::dict describe() const;  ///< the robot, as the Python class documents it

 private:
  struct Rows;
  void sense(const Rows& rows, pybind11::ssize_t row) noexcept;
  double since_last(double time, double rounding) const noexcept;  ///< s

  EstimatorParameters given_;       ///< before anything was read from the file
  EstimatorParameters parameters_;  ///< the run begins with
  RobotModel robot_;
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
