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
  robot.wheels = {WheelModel{.joint = 0, .centre_base = {0, 0.25, 0.1}, .radius = 0.1, .width = 0.03, .inertia = 0.005},
                  WheelModel{.joint = 1,
                             .centre_base = {0, -0.25, 0.1},
                             .radius = 0.1,
                             .width = 0.03,
                             .inertia = 0.005,
                             .side = Side::kRight}};
  robot.wheel_base = 0.5;
  return robot;
}

/// Axles 0.4 m apart, the front one 0.3 m ahead of base_link; left joints are mirrored; effective wheel base 0.82 m.
inline RobotModel four_wheeler() {
  RobotModel robot = two_wheeler();
  robot.joints.assign(4, {.name = "wheel", .child_link = "link"});  // no limits known
  robot.wheels = {robot.wheels[0], robot.wheels[0], robot.wheels[1], robot.wheels[1]};
  for (std::size_t i = 0; i < 4; ++i) {
    robot.wheels[i].joint = i;
    robot.wheels[i].centre_base[0] = i % 2 == 0 ? 0.3 : -0.1;
    robot.wheels[i].sign = i < 2 ? -1 : 1;
  }
  robot.wheel_base_multiplier = 1.64;
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
    frame_.joint_count = model.joints.size();
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
    const double difference = angular * model_.effective_wheel_base() / 2;
    for (const WheelModel& wheel : model_.wheels) {
      turn_wheel(wheel, wheel.side == Side::kLeft ? linear - difference : linear + difference, dt);
    }
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
