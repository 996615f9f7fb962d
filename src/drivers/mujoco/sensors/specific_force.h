#pragma once
/// SpecificForce computes the value of an exact accelerometer at the IMU: its mean over one MuJoCo step of h seconds,
/// in the IMU's axes,
///
///   f = ½ (R₀ + R₁)ᵀ ((v₁ − v₀)/h − g)
///
/// v  velocity of the IMU's origin, world axes     R  IMU → world     g  gravity     0, 1: before, after the step
///
/// By this definition R f + g integrates to the velocity. MuJoCo's own accelerometer does not integrate to it. Its
/// acceleration lacks the implicit part of joint damping, with which the Euler integrator moves the robot (mj_EulerSkip
/// in MuJoCo's engine_forward.c). With wheel-joint damping of 1 N·m·s/rad it integrates to twice the true velocity.

#include <Eigen/Core>

#include "drivers/mujoco/model/mujoco_model.h"

namespace robot_control {

class SpecificForce {
 public:
  explicit SpecificForce(const MujocoModel& model);

  /// Begins at the state that mj_step1 has just evaluated.
  void reset(const mjData& data) noexcept;

  /// Returns f in m/s² over the step that ended at the state that mj_step1 has just evaluated.
  Eigen::Vector3d step(const mjData& data) noexcept;

 private:
  const mjModel* model_;
  int site_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();         ///< v₀
  Eigen::Matrix3d orientation_ = Eigen::Matrix3d::Identity();  ///< R₀
};

}  // namespace robot_control
