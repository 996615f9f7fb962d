#pragma once
/// The torque that wheels behind each other need because their treads slide over the ground in a turn.
///
/// At twist (v, ω), ω about the point between the wheels, with the geometric wheel base b, the effective one b_eff and
/// xᵢ the axle's position from the mean of all, the tread of wheel i on side s (−1 left, +1 right) slides over the
/// ground, along and across its rolling direction, with
///
///   s·ω·d and −ω·xᵢ,   d = (b_eff − b)/2,   together |ω|·lᵢ,   lᵢ = √(d² + xᵢ²)
///
/// Coulomb friction opposes it. The wheel of radius r with load Nᵢ therefore has to drive, at friction μ,
///
///   τᵢ = μ·r·Nᵢ·d/lᵢ · s·ω·lᵢ/√((ω·lᵢ)² + (κ·v_rim)² + ε²)     (times the joint's sign)
///
/// whatever the speed of the turn. A rolling tyre slides in full only from a slip of about κ of its rim speed v_rim =
/// v + s·ω·b_eff/2, κ = 0.05 (tyre.h); ε = 5 mm/s blends the sign of ω near zero.
///
/// Treads are elastic: that torque builds up, and turns round, over the way that they slide, and stays where they stop.
/// New tread rolls into the contact within about a tenth of a radius, of hard wheels. With ρᵢ = √((ω·lᵢ)² + (κ·v_rim)²)
///
///   żᵢ = (τᵢ − zᵢ)·ρᵢ/(κ·rᵢ/10)     zᵢ: the torque now, τᵢ as above with ε = 0, both at friction 1
///
/// The weight is carried by the drive wheels alone, linearly along x: Nᵢ = (m·g/n)·(1 + x_c·xᵢ/mean(x²)), but not below
/// 0, with x_c the centre of gravity ahead of the mean. One wheel a side rolls without scrub: all torques are 0.

#include <array>

#include "robot/robot_model.h"

namespace robot_control {

class Scrub {
 public:
  explicit Scrub(const RobotModel& robot) noexcept;

  /// N·m per wheel at friction 1, in the joint's own sign; `linear` m/s, `angular` rad/s.
  std::array<double, kMaxWheels> efforts(double linear, double angular) const noexcept;

  /// The same of the twist at which the wheels turn with `speeds`, rad/s of their joints.
  std::array<double, kMaxWheels> efforts(const std::array<double, kMaxWheels>& speeds) const noexcept;

  /// z of the law, N·m in the joint's own sign, after `dt` s more at this twist. Returns ρ·dt, m, mean of the wheels.
  double strain(std::array<double, kMaxWheels>& efforts, double linear, double angular, double dt) const noexcept;

  /// N·m, the largest of any turn at friction 1, without sign.
  double most(std::size_t wheel) const noexcept { return wheels_[wheel].effort; }

  /// The same in a turn to the left, in the joint's own sign.
  double most_to_left(std::size_t wheel) const noexcept { return wheels_[wheel].turn * wheels_[wheel].effort; }

 private:
  struct Wheel {
    double effort = 0;  ///< N·m, μ = 1, all sliding
    double lever = 0;   ///< m, lᵢ
    double side = 0;    ///< s
    double turn = 0;    ///< s times the joint's sign
    double rim = 0;     ///< m/s of the side per rad/s of the joint
    double way = 0;     ///< m, κ·rᵢ/10
  };

  std::size_t count_;
  double half_base_;  ///< m, b_eff/2
  std::array<Wheel, kMaxWheels> wheels_{};
};

}  // namespace robot_control
