#pragma once
/// A robot that rolls on even or tilted ground, its truth, and the measurements of ideal sensors, for tests of the
/// estimator. Within a cycle its velocities change evenly from those of the beginning to those of the end:
///
///   R ← R Exp(ω̄ dt)     p ← p + dt R½ v̄     f = R½ᵀ ((V₁ − V₀)/dt + g)      (¯ mean, ½ middle, V of the IMU, odom
///   axes)
///
/// each exact to O(dt³). The gyro reads the rate of the cycle's end, the accelerometer the mean over the cycle,
/// encoders the travel of the contacts.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "estimation/wheeled/estimator_parameters.h"
#include "estimation/wheeled/wheels/wheel_geometry.h"
#include "machine/wheeled/drive_train.h"
#include "signals/sensor_frame.h"

namespace robot_control {

inline DriveTrain two_wheeler() {
  DriveTrain robot;
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
inline DriveTrain four_wheeler() {
  DriveTrain robot = two_wheeler();
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

/// Parameters for a RollingRobot whose tyres do not creep.
inline EstimatorParameters rigid_tyres() {
  return {.tyre_creep = 0};
}

/// Motion of the middle between the contacts, in base axes.
struct Rolling {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();      ///< rad/s
};

/// White noise of the inertial sensors.
struct SensorNoise {
  double gyro = 0;           ///< rad/s/√Hz
  double accelerometer = 0;  ///< m/s²/√Hz
  double counts = 0;         ///< of an encoder's turn; 0: no quantisation
};

class RollingRobot {
 public:
  static constexpr double kPeriod = 1e-3;
  static constexpr double kGravity = 9.80665;       ///< m/s²
  static constexpr double kAcceleration = 1.0;      ///< m/s², of `drive`
  static constexpr double kTurnAcceleration = 4.0;  ///< rad/s², of `drive`

  explicit RollingRobot(const DriveTrain& model = two_wheeler(), double period = kPeriod, unsigned seed = 1)
      : model_(model), wheels_(model), period_(period), random_(seed) {
    const Quaternion& q = model.imu_in_base.orientation;
    base_from_imu_ = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
    imu_ = Eigen::Vector3d(model.imu_in_base.position.data());
    frame_.head.run = 7;
    set_joints_valid(frame_, kValidMotion);
    frame_.valid = kValidGyro | kValidAccelerometer;
    frame_.joint_count = model.joints.size();
    read_imu({0, 0, kGravity});
  }

  /// The frame of the present cycle.
  const SensorFrame& frame() const { return frame_; }
  SensorFrame& frame() { return frame_; }

  /// Runs one cycle; at its end the robot moves as `end` says.
  void go(const Rolling& end) {
    const Eigen::Matrix3d before = rotation;
    const Eigen::Vector3d rate = (motion.rate + end.rate) / 2;
    const Eigen::Matrix3d middle = before * turned(rate * (period_ / 2));
    rotation = before * turned(rate * period_);
    const Eigen::Vector3d step = period_ * middle * (of_point(motion, {0, 0, 0}) + of_point(end, {0, 0, 0})) / 2;
    position += step;
    distance += std::abs((motion.velocity.x() + end.velocity.x()) / 2) * period_;
    const Eigen::Vector3d gained = rotation * of_point(end, imu_) - before * of_point(motion, imu_);
    const Eigen::Vector3d force = middle.transpose() * (gained / period_ + Eigen::Vector3d(0, 0, kGravity));
    const Eigen::Vector3d axle = ground();
    const Eigen::Vector3d pushed = rotation * of_point(end, axle) - before * of_point(motion, axle);
    roll(motion, end, middle.col(0).dot(pushed / period_ + Eigen::Vector3d(0, 0, kGravity)));
    motion = end;
    ++frame_.head.cycle;
    read_imu(force);
  }

  /// Runs one cycle with constant acceleration towards a planar twist, until it is reached. `pitch_rate`: at its end,
  /// rad/s.
  void drive(double linear, double angular, double pitch_rate = 0) {
    Rolling end = motion;
    const auto towards = [&](double from, double to, double rate) {
      return from + std::clamp(to - from, -rate * period_, rate * period_);
    };
    end.velocity.x() = towards(motion.velocity.x(), linear, kAcceleration);
    end.rate.z() = towards(motion.rate.z(), angular, kTurnAcceleration);
    end.rate.y() = pitch_rate;
    end.velocity.y() = -creep * std::abs(end.velocity.x()) * end.velocity.x() * end.rate.z();
    go(end);
  }

  double x() const { return position.x(); }
  double y() const { return position.y(); }
  double yaw() const { return std::atan2(rotation(1, 0), rotation(0, 0)); }

  Rolling motion;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, of base_link
  double distance = 0;                                 ///< m

  // Errors of robot and sensors.
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< rad/s, IMU axes
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< m/s², IMU axes
  double radius_ratio = 0;                                       ///< right over left radius, beyond 1
  double wheel_base = 0;                                         ///< effective wheel base over the model's, beyond 1
  double creep = 0;                                              ///< s²/m, of the tyres; across, on even ground
  SensorNoise noise;
  std::array<std::optional<double>, 2> tread;  ///< m/s, of a side's treads that do not roll

 private:
  static Eigen::Matrix3d turned(const Eigen::Vector3d& angle) {
    const double norm = angle.norm();
    if (norm == 0) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(norm, angle / norm).toRotationMatrix();
  }

  /// m, base axes: below the middle of the axles
  Eigen::Vector3d ground() const {
    const auto [x, y, z] = wheels_.axle;
    return {x, y, z - model_.wheels.front().radius};
  }

  Eigen::Vector3d of_point(const Rolling& m, const Eigen::Vector3d& point) const {
    return m.velocity + m.rate.cross(point - ground());
  }

  void roll(const Rolling& from, const Rolling& to, double force) {
    const double half = wheels_.wheel_base * (1 + wheel_base) / 2;
    for (const std::size_t side : {0U, 1U}) {
      const double sign = side == 0 ? 1 : -1;
      const Eigen::Vector3d contact = ground() + Eigen::Vector3d(0, sign * half, 0);
      const double rolling = (of_point(from, contact).x() + of_point(to, contact).x()) / 2;
      const double turning = rolling + creep * std::abs(rolling) * force;
      turn_[side] += period_ * tread[side].value_or(turning) / (1 - sign * radius_ratio / 2);
    }
    for (const WheelModel& wheel : model_.wheels) {
      double angle = wheel.sign * turn_[wheel.side == Side::kLeft ? 0 : 1] / wheel.radius;
      if (noise.counts > 0) {
        const double count = 2 * std::numbers::pi / noise.counts;
        angle = std::floor(angle / count) * count;
      }
      frame_.joints[wheel.joint].position = angle;
    }
  }

  void read_imu(const Eigen::Vector3d& force) {
    const Eigen::Vector3d rate = base_from_imu_.transpose() * motion.rate + gyro_bias + white(noise.gyro);
    const Eigen::Vector3d felt = base_from_imu_.transpose() * force + accelerometer_bias + white(noise.accelerometer);
    frame_.imu.angular_velocity = {rate.x(), rate.y(), rate.z()};
    frame_.imu.linear_acceleration = {felt.x(), felt.y(), felt.z()};
  }

  Eigen::Vector3d white(double density) {
    if (density == 0) return Eigen::Vector3d::Zero();
    const double deviation = density / std::sqrt(period_);
    const double a = normal_(random_);
    const double b = normal_(random_);
    const double c = normal_(random_);
    return deviation * Eigen::Vector3d(a, b, c);
  }

  DriveTrain model_;
  WheelGeometry wheels_;
  double period_;
  Eigen::Matrix3d base_from_imu_;
  Eigen::Vector3d imu_;
  std::array<double, 2> turn_{};  ///< m, of the treads
  SensorFrame frame_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0, 1};
};

inline double yaw_of(const Pose& pose) {
  return 2 * std::atan2(pose.orientation[2], pose.orientation[3]);
}

}  // namespace robot_control
