#pragma once
/// An estimator on a rolling robot, with which most of its tests begin.

#include <gtest/gtest.h>

#include <cmath>

#include "estimation/wheeled/estimator.h"
#include "estimation/wheeled/rolling_robot.h"
#include "support/positive_definite.h"

namespace robot_control {

inline bool all_finite(const StateFrame& state) {
  bool good = std::isfinite(state.base.distance);
  const auto check = [&](const auto& values) {
    for (const double value : values) good = good && std::isfinite(value);
  };
  check(state.base.pose_odom.position);
  check(state.base.pose_odom.orientation);
  check(state.base.twist_base.linear);
  check(state.base.twist_base.angular);
  check(state.base.pose_covariance);
  check(state.base.twist_covariance);
  check(state.base.gyro_bias);
  check(state.base.gyro_bias_deviation);
  check(state.base.accelerometer_bias);
  check(state.base.attitude);
  check(state.base.attitude_covariance);
  check(state.wheeled.nis);
  check(std::array{state.wheeled.calibration.radius_ratio, state.wheeled.calibration.wheel_base_factor,
                   state.wheeled.calibration.radius_ratio_deviation, state.wheeled.calibration.wheel_base_deviation});
  check(std::array{state.wheeled.odometry.x, state.wheeled.odometry.y, state.wheeled.odometry.yaw,
                   state.wheeled.odometry.linear, state.wheeled.odometry.angular});
  for (const double value : state.wheeled.confidence) good = good && value >= 0 && value <= 1;
  return good;
}

/// positive_definite() of what a state publishes.
inline bool is_covariance(const Matrix6& published, double slack) {
  return positive_definite([&](std::size_t i, std::size_t j) { return published[6 * i + j]; }, 6, slack);
}

struct EstimatorFixture : testing::Test {
  explicit EstimatorFixture(const DriveTrain& model = two_wheeler(),
                            const EstimatorParameters& parameters = rigid_tyres(),
                            double period = RollingRobot::kPeriod)
      : robot_(model, period), estimator_(parameters, model, period) {}

  void observe() { estimator_.step(robot_.frame(), state_); }
  /// Drives towards a planar twist with the accelerations of RollingRobot::drive.
  void drive(double linear, double angular, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      robot_.drive(linear, angular);
      observe();
    }
  }
  void stand(int cycles = 1000) {
    observe();
    drive(0, 0, cycles);
  }
  /// Runs one cycle at the present twist after `fault` has changed the frame.
  template <class Fault>
  void broken(Fault fault) {
    robot_.go(robot_.motion);
    SensorFrame frame = robot_.frame();
    fault(frame);
    estimator_.step(frame, state_);
  }
  bool has(StateFlag flag) const { return (state_.base.flags & flag) != 0; }
  double x() const { return state_.base.pose_odom.position[0]; }
  double y() const { return state_.base.pose_odom.position[1]; }
  double yaw() const { return yaw_of(state_.base.pose_odom); }
  double speed() const { return state_.base.twist_base.linear[0]; }
  double position_error() const { return std::hypot(x() - robot_.x(), y() - robot_.y()); }
  double yaw_error() const { return std::abs(std::remainder(yaw() - robot_.yaw(), 2 * std::numbers::pi)); }

  RollingRobot robot_;
  Estimator estimator_;
  StateFrame state_;
};

}  // namespace robot_control
