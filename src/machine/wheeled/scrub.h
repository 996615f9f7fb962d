#pragma once
/// Computes the torque that wheels behind each other need because their treads slide over the ground in a turn.
///
/// The twist (v, ω) belongs to the point between the wheels. The wheel base is b geometrically and b_eff effectively,
/// and xᵢ is the axle's position from the mean of all. The tread of wheel i on side s (−1 left, +1 right) slides over
/// the ground, along and across its rolling direction, with
///
///   s·ω·d and −ω·xᵢ,   d = (b_eff − b)/2,   together |ω|·lᵢ,   lᵢ = √(d² + xᵢ²)
///
/// Coulomb friction opposes it. At friction μ the wheel of radius r with load Nᵢ therefore has to drive, at any speed
/// of the turn,
///
///   τᵢ = μ·r·Nᵢ·d/lᵢ · s·ω·lᵢ/√((ω·lᵢ)² + (κ·v_rim)² + ε²)     (times the joint's sign)
///
/// A rolling tyre slides in full only from a slip of about κ = 0.05 of its rim speed v_rim = v + s·ω·b_eff/2 (tyre.h).
/// ε = 5 mm/s blends the sign of ω near zero.
///
/// Treads are elastic. That torque builds up and reverses over the distance that they slide, and it stays when they
/// stop. New tread of hard wheels rolls into the contact within about a tenth of a radius. With ρᵢ = √((ω·lᵢ)² +
/// (κ·v_rim)²)
///
///   żᵢ = (τᵢ − zᵢ)·ρᵢ/(κ·rᵢ/10)     zᵢ: the torque now, τᵢ as above with ε = 0, both at friction 1
///
/// The drive wheels alone carry the weight, linearly along x: Nᵢ = (m·g/n)·(1 + x_c·xᵢ/mean(x²)), but not below 0. x_c
/// is the centre of gravity ahead of the mean. One wheel a side rolls without scrub: all torques are 0.

#include <array>

#include "machine/wheeled/drive_train.h"

namespace robot_control {

class Scrub {
 public:
  explicit Scrub(const DriveTrain& robot) noexcept;

  /// Returns N·m per wheel at friction 1, in the joint's own sign; `linear` is in m/s and `angular` in rad/s.
  std::array<double, kMaxWheels> efforts(double linear, double angular) const noexcept;

  /// Returns the same for the twist at which the joints turn with `speeds`, rad/s.
  std::array<double, kMaxWheels> efforts(const std::array<double, kMaxWheels>& speeds) const noexcept;

  /// Updates z of the law, N·m in the joint's own sign, over `dt` s at this twist. Returns ρ·dt in m, mean of the
  /// wheels.
  double strain(std::array<double, kMaxWheels>& efforts, double linear, double angular, double dt) const noexcept;

  /// Returns the largest torque of any turn at friction 1, N·m, without sign.
  double max_effort(std::size_t wheel) const noexcept { return wheels_[wheel].effort; }

  /// Returns the largest torque of a turn to the left, in the joint's own sign.
  double max_effort_to_left(std::size_t wheel) const noexcept { return wheels_[wheel].turn * wheels_[wheel].effort; }

 private:
  struct Wheel {
    double effort = 0;    ///< N·m at μ = 1 with all treads sliding
    double lever = 0;     ///< m, lᵢ
    double side = 0;      ///< s
    double turn = 0;      ///< s times the joint's sign
    double rim = 0;       ///< m/s of the side per rad/s of the joint
    double distance = 0;  ///< m, κ·rᵢ/10
  };

  std::size_t count_;
  double half_base_;  ///< m, b_eff/2
  std::array<Wheel, kMaxWheels> wheels_{};
};

}  // namespace robot_control
