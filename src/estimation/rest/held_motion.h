#pragma once
/// This type holds the motion that wheels and gyro measure while the robot is taken to rest. It is kept until the next
/// window is quiet, too. If a window is not quiet, the held motion is integrated.

#include <Eigen/Core>
#include <optional>

#include "estimation/values.h"

namespace robot_control {

struct HeldMotion {
  double time = 0;                                 ///< s
  double left = 0, right = 0;                      ///< m
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< rad, base axes, gyro bias included
  Planar velocity{};                               ///< m/s, base axes, integral of the acceleration
  bool gyro = true;                                ///< The gyro was present all the time.

  void step(double dt, double left_travel, double right_travel, const std::optional<Eigen::Vector3d>& rate,
            const Planar& acceleration) noexcept {
    time += dt;
    left += left_travel;
    right += right_travel;
    velocity = velocity + acceleration * dt;
    gyro = gyro && rate;
    if (rate) turn += *rate * dt;
  }
  void add(const HeldMotion& other) noexcept {
    time += other.time;
    left += other.left;
    right += other.right;
    turn += other.turn;
    velocity = velocity + other.velocity;
    gyro = gyro && other.gyro;
  }
};

}  // namespace robot_control
