#pragma once
/// A robot whose truth is known in closed form, and its sensors, for tests of the estimator.

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "robot/robot_model.h"
#include "signals/sensor_frame.h"

namespace robot_control {

inline RobotModel two_wheeler() {
  RobotModel robot;
  robot.name = "two_wheeler";
  robot.joints = {{"left", "left_link", 5.0, 30.0}, {"right", "right_link", 5.0, 30.0}};
  robot.left = {.joint = 0, .centre_base = {0, 0.25, 0.1}, .radius = 0.1, .width = 0.03, .sign = 1, .inertia = 0.005};
  robot.right = {.joint = 1, .centre_base = {0, -0.25, 0.1}, .radius = 0.1, .width = 0.03, .sign = 1, .inertia = 0.005};
  robot.wheel_base = 0.5;
  return robot;
}

/// Wheel angles and gyro as ideal sensors see them. `go` holds linear and angular speed for one cycle and moves
/// the truth by the closed form of a circular arc about its instantaneous centre.
class PlanarRobot {
 public:
  static constexpr double kPeriod = 1e-3;

  explicit PlanarRobot(const RobotModel& model = two_wheeler()) : model_(model) {
    frame_.head.run = 7;
    frame_.valid = kValidJoints | kValidGyro | kValidAccelerometer;
    frame_.joint_count = 2;
    frame_.imu.linear_acceleration = {0, 0, 9.80665};
  }

  /// The frame of the present cycle.
  const SensorFrame& frame() const { return frame_; }
  SensorFrame& frame() { return frame_; }

  void go(double linear, double angular, std::uint64_t cycles = 1) {
    const double dt = static_cast<double>(cycles) * kPeriod;
    if (angular == 0) {
      x += linear * dt * std::cos(yaw);
      y += linear * dt * std::sin(yaw);
    } else {
      const double radius = linear / angular;
      x += radius * (std::sin(yaw + angular * dt) - std::sin(yaw));
      y -= radius * (std::cos(yaw + angular * dt) - std::cos(yaw));
    }
    yaw += angular * dt;
    distance += std::abs(linear) * dt;
    turn_wheel(model_.left, linear - angular * model_.wheel_base / 2, dt);
    turn_wheel(model_.right, linear + angular * model_.wheel_base / 2, dt);
    frame_.imu.angular_velocity = {0, 0, angular + bias};
    frame_.head.cycle += cycles;
  }

  double x = 0, y = 0, yaw = 0;
  double distance = 0;
  double bias = 0;  ///< rad/s, of the gyro

 private:
  void turn_wheel(const WheelModel& wheel, double speed, double dt) {
    const double rate = wheel.sign * speed / wheel.radius;
    frame_.joints[wheel.joint].position += rate * dt;
    frame_.joints[wheel.joint].velocity = rate;
  }

  RobotModel model_;
  SensorFrame frame_;
};

inline double yaw_of(const Pose& pose) {
  return 2 * std::atan2(pose.orientation[2], pose.orientation[3]);
}

}  // namespace robot_control
