#pragma once
/// The equations of motion of a robot on four legs, with 18 degrees of freedom:
///
///   M(q) a + h(q, q̇, ω, v) = τ + Σ Jᵀ f,    a = [ Rᵀ p̈, ω̇, q̈ ],  velocities [ v, ω, q̇ ]
///
/// v, ω: velocity and angular velocity of the base in its own axes. Rᵀ p̈ is the acceleration of the base's origin, in
/// the base's axes. It is not v̇, but v̇ + ω × v. h has Coriolis and centrifugal forces and gravity.
/// Rows and columns are three of the force, three of the moment, twelve of the joints in the order of LegModel.
///
/// M is the sum of composite bodies, h a recursive Newton-Euler step with a = 0 (R. Featherstone, Rigid Body Dynamics
/// Algorithms, Springer 2008, tables 6.2 and 9.1). All quantities are in the base's axes about its origin, so that no
/// body needs a transformation. The reflected inertia of the rotors is on the diagonal of M; it has no gyroscopic part.
///
/// The masses are those of the URDF. All functions are real-time safe.

#include <Eigen/Core>
#include <array>

#include "machine/legs/leg_model.h"

namespace robot_control {

inline constexpr int kLeggedDofs = 6 + static_cast<int>(kLegsJoints);

struct LeggedMotion {
  LegsValues angles{};                                     ///< rad
  LegsValues rates{};                                      ///< rad/s
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();        ///< m/s, v
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();       ///< rad/s, ω
  Eigen::Vector3d gravity = Eigen::Vector3d(0, 0, -9.81);  ///< m/s², base axes
};

struct LeggedAcceleration {
  LegsValues joints{};                                ///< rad/s²
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s², ω̇
};

struct LeggedEquations {
  Eigen::Matrix<double, kLeggedDofs, kLeggedDofs> mass = Eigen::Matrix<double, kLeggedDofs, kLeggedDofs>::Zero();
  Eigen::Matrix<double, kLeggedDofs, 1> bias = Eigen::Matrix<double, kLeggedDofs, 1>::Zero();
  Eigen::Vector3d centre_of_gravity = Eigen::Vector3d::Zero();  ///< m, base axes
};

class LegDynamics {
 public:
  LegDynamics() = default;
  explicit LegDynamics(const LegModel& model);

  void step(const LeggedMotion& motion, LeggedEquations& out) const noexcept;

  /// Returns the efforts in N·m of leg `leg` while no force acts on its foot: its rows of M a + h. A base that
  /// accelerates counts as one in another gravity: `motion.gravity` is g − Rᵀ p̈.
  Eigen::Vector3d efforts(std::size_t leg, const LeggedMotion& motion, const LeggedAcceleration& change) const noexcept;

  /// Returns the robot's mass in kg.
  double mass() const noexcept { return mass_; }

 private:
  /// A body at the zero pose in the base's axes; `centre` is relative to the origin of its joint.
  struct Body {
    double mass = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre
  };
  std::array<LegGeometry, kLegs> geometry_{};
  std::array<std::array<Body, kLegJoints>, kLegs> bodies_{};
  Body base_;
  double rotor_inertia_ = 0;
  double mass_ = 0;
};

}  // namespace robot_control
