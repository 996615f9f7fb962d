#pragma once
/// step_tyre computes the friction of one wheel contact with a brush tyre.
///
/// The tread is a brush of elastic bristles between rim and ground. Its mean deflection z is a vector in the contact
/// plane. The slip velocity v increases z, and the rolling rim carries z out of the contact:
///
///   ż = v − |u|/L · z         F = −k z − c v         |F| ≤ μ N
///
/// v  velocity of the wheel's material at the contact over the ground   u  rim speed, r q̇
/// N  normal force of the previous step                                 L  relaxation length
///
/// At the bound F points against k z + c v, and |z| ≤ μ N / k: the tread slides, and Coulomb friction opposes it. A
/// wheel that does not turn (u = 0) acts as a spring without creep. A rolling wheel under a force F creeps with v =
/// F/(k L/|u| + c), like real tyres. Below a rim speed of 0.1 r per second u counts as zero, so that a wheel held on
/// encoder counts does not creep. Turn slip ω has the same law with an angle φ about the normal:
///
///   φ̇ = ω − |u|/L · φ         M = −(k φ + c ω) ρ²     |M| ≤ μ N ϱ
///
/// ρ = 0.2 r is the lever of the bristles and ϱ = 0.01 r that of their bound: a wheel of 0.1 m touches within
/// millimetres. Source: Pacejka, Tire and Vehicle Dynamics, ch. 3 and 7; the state is of the Dahl family.
///
/// With m the effective mass at the contact and h the time step, the parameters are:
///
///   c = 0.3 m/h    k = 0.1 m/h²    L = max(r/2, 20 N₀/k),  N₀ the wheel's load at rest
///
/// A force of N₀/20 then causes at most 0.25 % of creep on a robot of any mass. A step is stable with a margin of 5.7
/// at any u, as shown in docs/simulation.md.

#include <Eigen/Core>

namespace robot_control {

struct TyreParameters {
  double stiffness = 0;          ///< k, N/m
  double damping = 0;            ///< c, N·s/m
  double relaxation_length = 1;  ///< L, m
  double dead_band = 0;          ///< m/s; a smaller rim speed counts as zero
  double twist_lever = 0;        ///< ρ, m
  double twist_bound = 0;        ///< ϱ, m
};

/// Returns the parameters above. `mass` is m in kg, `radius` r in m, `load` N₀ in N, `step` h in s; all are above zero.
TyreParameters tyre_parameters(double mass, double radius, double load, double step);

struct TyreInput {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< v in the contact plane, m/s
  double turn_rate = 0;                                ///< ω about the normal, rad/s
  double rim_speed = 0;                                ///< u, m/s
  double grip = 0;                                     ///< μ N, N
};

struct TyreForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, force on the wheel in the contact plane
  double torque = 0;                                ///< N·m, torque on the wheel about the normal
};

struct TyreState {
  Eigen::Vector3d deflection = Eigen::Vector3d::Zero();  ///< z, m
  double twist = 0;                                      ///< φ, rad
};

/// Computes one step of `dt` s. NaN in the input gives NaN in the result.
TyreForce step_tyre(const TyreParameters& tyre, TyreState& state, const TyreInput& input, double dt) noexcept;

}  // namespace robot_control
