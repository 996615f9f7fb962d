#pragma once
/// The friction of one wheel contact: a brush tyre.
///
/// The tread is a brush of elastic bristles between rim and ground. Its mean deflection z, a vector in the contact
/// plane, grows with the slip velocity v and is carried out of the contact by the rolling of the rim:
///
///   ż = v − |u|/L · z         F = −k z − c v         |F| ≤ μ N
///
/// v  velocity of the wheel's material at the contact over the ground   u  rim speed, r q̇
/// N  normal force of the previous step                                 L  relaxation length
///
/// At the bound F points against k z + c v, and |z| ≤ μ N / k: the tread slides, Coulomb friction opposes it. Held
/// still (u = 0) it is a spring: no creep. Rolling under a force F it creeps with v = F / (k L/|u| + c), as tyres do.
/// Below a rim speed of 0.1 r per second u counts as zero: a wheel held on encoder counts does not creep. Turn slip
/// has its twin φ about the normal: φ̇ = ω − |u|/L · φ, M = −(k φ + c ω) ρ², |M| ≤ μ N ϱ, with ρ = 0.2 r the lever of
/// the bristles and ϱ = 0.01 r that of their bound: a wheel of 0.1 m touches within millimetres.
/// (Pacejka, Tire and Vehicle Dynamics, ch. 3 and 7; the state is of the Dahl family.)
///
/// Numbers. With m the mass that answers to a force at the contact and h the time step:
///
///   c = 0.3 m/h    k = 0.1 m/h²    L = max(r/2, 20 N₀/k),  N₀ the wheel's load at rest
///
/// so a twentieth of N₀ costs at most 0.25 % of creep, on a robot of any mass. For m = 0.5 kg and h = 1 ms:
/// 150 N·s/m, 5·10⁴ N/m.
///
/// Stability: F is computed at t and applied over [t, t + h]. On a mass m, sticking and standing, with
/// a = c h / m, b = k h² / m,
///
///   v' = v − a v − (b/h) z',  z' = z + h v      (v, z at t; F uses z', the deflection after this step)
///
/// z² − (2 − a − b) z + (1 − a) has its roots inside the unit circle for 2a + b < 4. Here 0.7: a factor of 5.7 to the
/// limit; damping ratio c / (2 √(k m)) = 0.47. Relaxation is implicit, z' = (z + h v)/(1 + h |u|/L), stable at any u.

#include <Eigen/Core>

namespace robot_control {

struct TyreParameters {
  double stiffness = 0;          ///< k, N/m
  double damping = 0;            ///< c, N·s/m
  double relaxation_length = 1;  ///< L, m
  double dead_band = 0;          ///< m/s, rim speed that counts as zero
  double twist_lever = 0;        ///< ρ, m
  double twist_bound = 0;        ///< ϱ, m
};

/// The numbers above. `mass` m in kg, `radius` in m, `load` N₀ in N, `step` h in s; all above zero.
TyreParameters tyre_parameters(double mass, double radius, double load, double step);

struct TyreInput {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< v in the contact plane, m/s
  double turn_rate = 0;                                ///< ω about the normal, rad/s
  double rim_speed = 0;                                ///< u, m/s
  double grip = 0;                                     ///< μ N, N
};

struct TyreForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, on the wheel, in the contact plane
  double torque = 0;                                ///< N·m, on the wheel, about the normal
};

struct TyreState {
  Eigen::Vector3d deflection = Eigen::Vector3d::Zero();  ///< z, m
  double twist = 0;                                      ///< φ, rad
};

/// One step of `dt` s; NaN in the input comes out as NaN.
TyreForce step_tyre(const TyreParameters& tyre, TyreState& state, const TyreInput& input, double dt) noexcept;

}  // namespace robot_control
