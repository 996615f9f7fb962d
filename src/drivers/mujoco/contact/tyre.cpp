#include "drivers/mujoco/contact/tyre.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

TyreParameters tyre_parameters(double mass, double radius, double load, double step) {
  TyreParameters tyre;
  tyre.damping = 0.3 * mass / step;
  tyre.stiffness = 0.1 * mass / (step * step);
  tyre.relaxation_length = std::max(radius / 2, 20 * load / tyre.stiffness);
  tyre.dead_band = 0.1 * radius;
  tyre.twist_lever = 0.2 * radius;
  tyre.twist_bound = 0.01 * radius;
  return tyre;
}

TyreForce step_tyre(const TyreParameters& tyre, TyreState& state, const TyreInput& input, double dt) noexcept {
  const double rim_speed = std::max(0.0, std::abs(input.rim_speed) - tyre.dead_band);
  const double kept = 1 / (1 + dt * rim_speed / tyre.relaxation_length);
  TyreForce result;

  Eigen::Vector3d& z = state.deflection;
  z = (z + dt * input.velocity) * kept;
  z -= z.dot(input.normal) * input.normal;
  result.force = -tyre.stiffness * z - tyre.damping * input.velocity;
  const double force = result.force.norm();
  if (force > input.grip) {
    result.force *= input.grip / force;
    const double stretched = tyre.stiffness * z.norm();
    if (stretched > input.grip) z *= input.grip / stretched;
  }

  const double lever = tyre.twist_lever * tyre.twist_lever;
  const double bound = input.grip * tyre.twist_bound;
  state.twist = (state.twist + dt * input.turn_rate) * kept;
  result.torque = std::clamp(-(tyre.stiffness * state.twist + tyre.damping * input.turn_rate) * lever, -bound, bound);
  const double furthest = bound / (tyre.stiffness * lever);
  state.twist = std::clamp(state.twist, -furthest, furthest);
  return result;
}

}  // namespace robot_control
