#pragma once
/// Checks that the accelerometer integrates to the velocity. With the true attitude R of the IMU and the true velocity
/// v of its origin, on level ground,
///
///   e = Σ (R̄ f + g) T − v        R̄ halfway between the two ends of a period
///
/// is constant. `worst` is the largest change of |e| over a second, m/s.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "drivers/mujoco/constants.h"
#include "signals/sensor_frame.h"
#include "signals/truth_frame.h"

namespace robot_control {

class IntegratedForce {
 public:
  /// `imu`: pose of the IMU in the base. `period` in s.
  IntegratedForce(const Pose& imu, double period)
      : place_(imu.position.data()), mounting_(quaternion(imu.orientation)), period_(period) {}

  void add(const SensorFrame& sensors, const TruthFrame& truth) {
    const Eigen::Quaterniond base = quaternion(truth.pose_world.orientation);
    const Eigen::Vector3d linear(truth.twist_base.linear.data()), angular(truth.twist_base.angular.data());
    const Eigen::Quaterniond orientation = base * mounting_;
    if (!errors_.empty()) {
      const Eigen::Vector3d force(sensors.imu.linear_acceleration.data());
      integral_ += period_ * (orientation_.slerp(0.5, orientation) * force - kEarthGravity * Eigen::Vector3d::UnitZ());
    }
    orientation_ = orientation;
    errors_.emplace_back(integral_ - base * (linear + angular.cross(place_)));
  }

  double worst() const {
    double worst = 0;
    const auto second = static_cast<std::size_t>(std::lround(1 / period_));
    for (std::size_t i = second; i < errors_.size(); ++i) {
      worst = std::max(worst, (errors_[i] - errors_[i - second]).norm());
    }
    return worst;
  }

 private:
  static Eigen::Quaterniond quaternion(const Quaternion& q) { return {q[3], q[0], q[1], q[2]}; }

  Eigen::Vector3d place_;
  Eigen::Quaterniond mounting_;
  double period_;
  Eigen::Quaterniond orientation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> errors_;
};

}  // namespace robot_control
