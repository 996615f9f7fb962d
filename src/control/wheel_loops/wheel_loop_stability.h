#pragma once
/// Is the wheel loop stable? The eigenvalues of what really runs: tracking loop, PID and the bus's delay.
///
/// One wheel of inertia J in a joint of damping d, linear, sampled: the torque τ of cycle k acts over [t_k+1, t_k+2),
/// in which J·ω̇ = τ − d·ω. State
///
///   x = (θ̂ − θ, ω̂, residual, ω, τ of [t_k, t_k+1), τ of [t_k-1, t_k), integral)
///
/// where θ, ω are the wheel's and θ̂, ω̂, residual the tracking loop's. An actuator that is late by n cycles beyond the
/// bus' one adds n states, the torques under way; sensors that are late by n, torque and angle together, have the same
/// eigenvalues. x_k+1 = A·x_k; the loop is stable if and only if
/// the spectral radius max|λ(A)| < 1. After n cycles a disturbance has faded to about radius^n, so
/// ln(radius)/period is the slowest decay rate in 1/s.

#include "control/wheel_loops/wheel_loop.h"

namespace robot_control {

/// What the wheel really drives.
struct WheelLoad {
  double inertia = 0;  ///< kg·m², > 0
  double damping = 0;  ///< N·m·s/rad, ≥ 0

  bool operator==(const WheelLoad&) const noexcept = default;
};

/// `period` s, `bandwidth` Hz of the tracking loop; both > 0. `delay`: cycles beyond the bus' one.
double wheel_loop_spectral_radius(const WheelLoopGains& gains, const WheelLoad& load, double period, double bandwidth,
                                  unsigned delay = 0);

/// kp·dt/model_inertia: the quick rule. With kd = 0 and a tracking loop that is slow against the period
/// (2π·bandwidth·dt ≤ 0.25) the loop is unstable above 1 whatever the wheel drives; aim at ≤ 0.5. The spectral radius
/// is the criterion.
double stability_number(const WheelLoopGains& gains, double period) noexcept;

}  // namespace robot_control
