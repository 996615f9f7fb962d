#pragma once
/// Computes the stability of the wheel loop by the eigenvalues of the sampled system of tracking loop, PID and bus
/// delay.
///
/// One wheel of inertia J turns in a joint of damping d. The torque τ of cycle k acts over [t_k+1, t_k+2), during which
/// J·ω̇ = τ − d·ω. The state is
///
///   x = (θ̂ − θ, ω̂, residual, ω, τ of [t_k, t_k+1), τ of [t_k-1, t_k), integral)
///
/// θ and ω belong to the wheel; θ̂, ω̂ and residual to the tracking loop. An actuator with a delay of n cycles beyond
/// that of the bus adds n states, the torques under way. A delay of the sensors, torque and angle together, has the
/// same eigenvalues. With x_k+1 = A·x_k the loop is stable if and only if the spectral radius max|λ(A)| < 1. A
/// disturbance decays to about radius^n in n cycles, so ln(radius)/period is the slowest decay rate in 1/s.

#include "control/wheeled/wheel_loops/wheel_loop.h"

namespace robot_control {

/// Describes the load of the wheel.
struct WheelLoad {
  double inertia = 0;  ///< kg·m², > 0
  double damping = 0;  ///< N·m·s/rad, ≥ 0

  bool operator==(const WheelLoad&) const noexcept = default;
};

/// Returns the smallest damping ratio ζ = −Re(s)/|s| of all modes, with s = ln(λ)/period. 1: no mode oscillates; ≤ 0:
/// unstable. Each half oscillation of a mode is e^(−πζ/√(1−ζ²)) of the one before: 0.37 for ζ = 0.3.
double wheel_loop_damping_ratio(const WheelLoopGains& gains, const WheelLoad& load, double period, double bandwidth);

/// Returns the spectral radius. `period` (s) and `bandwidth` (Hz) of the tracking loop are > 0. `delay` counts cycles
/// beyond that of the bus.
double wheel_loop_spectral_radius(const WheelLoopGains& gains, const WheelLoad& load, double period, double bandwidth,
                                  unsigned delay = 0);

}  // namespace robot_control
