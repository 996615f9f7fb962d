#pragma once
/// Stability of the wheel loop: the eigenvalues of the sampled system of tracking loop, PID and the delay of the bus.
///
/// One wheel of inertia J in a joint of damping d, linear, sampled: the torque τ of cycle k acts over [t_k+1, t_k+2),
/// during which J·ω̇ = τ − d·ω. State
///
///   x = (θ̂ − θ, ω̂, residual, ω, τ of [t_k, t_k+1), τ of [t_k-1, t_k), integral)
///
/// θ, ω of the wheel; θ̂, ω̂, residual of the tracking loop. An actuator with a delay of n cycles beyond that of the
/// bus adds n states, the torques under way; sensors with a delay of n cycles, torque and angle together, have the same
/// eigenvalues. x_k+1 = A·x_k; the loop is stable if and only if the spectral radius max|λ(A)| < 1. After n cycles a
/// disturbance has decayed to about radius^n, so ln(radius)/period is the slowest decay rate in 1/s.

#include "control/wheel_loops/wheel_loop.h"

namespace robot_control {

/// The load of the wheel.
struct WheelLoad {
  double inertia = 0;  ///< kg·m², > 0
  double damping = 0;  ///< N·m·s/rad, ≥ 0

  bool operator==(const WheelLoad&) const noexcept = default;
};

/// The smallest damping ratio of all modes: with s = ln(λ)/period, ζ = −Re(s)/|s|. 1: no mode oscillates; ≤ 0:
/// unstable. Each half oscillation of a mode is e^(−πζ/√(1−ζ²)) of the one before: 0.37 for ζ = 0.3.
double wheel_loop_damping_ratio(const WheelLoopGains& gains, const WheelLoad& load, double period, double bandwidth);

/// `period` s, `bandwidth` Hz of the tracking loop; both > 0. `delay`: cycles beyond that of the bus.
double wheel_loop_spectral_radius(const WheelLoopGains& gains, const WheelLoad& load, double period, double bandwidth,
                                  unsigned delay = 0);

}  // namespace robot_control
