#pragma once
/// The motor torque that accelerates the robot as its wheel targets do.
///
/// With the mean rim acceleration a of the targets of each side, h wheels there, v̇ = (a_right + a_left)/2 and ω̇ =
/// (a_right − a_left)/b_eff, the wheel of radius r and axle inertia J on side s (−1 left, +1 right) takes
///
///   τ = r/h·(m·v̇/2 + s·I·ω̇/b) + J·a/r     (times the joint's sign)
///
/// robot as described. 0 while a wheel has no target, or had none one step ago. A wheel that nearly stands inside a
/// curve that begins has a large one: it holds its side while the other one goes around it.

#include <array>
#include <cstddef>

#include "machine/wheeled/drive_train.h"
#include "safety/measurements/wheel_targets.h"

namespace robot_control {

class PlannedTorque {
 public:
  explicit PlannedTorque(const DriveTrain& robot) noexcept;

  void enter_run() noexcept;

  /// `dt` s > 0 since the last step.
  void step(const WheelTargets& targets, double dt) noexcept;

  double operator[](std::size_t wheel) const noexcept { return torque_[wheel]; }  ///< N·m, in the joint's own sign

 private:
  struct Wheel {
    double side = 0;     ///< s
    double rim = 0;      ///< m, radius times the joint's sign
    double beside = 1;   ///< h
    double inertia = 0;  ///< kg·m², J
  };

  std::size_t count_;
  double mass_;
  double yaw_inertia_;
  double base_;            ///< m, b
  double effective_base_;  ///< m, b_eff
  std::array<Wheel, kMaxWheels> wheels_{};
  std::array<double, kMaxWheels> last_{};  ///< rad/s, targets
  bool had_all_ = false;
  std::array<double, kMaxWheels> torque_{};
};

}  // namespace robot_control
