#include "estimation/legged/plain_legs.h"

#include <algorithm>
#include <cmath>

#include "estimation/legged/small_turn.h"
#include "machine/gravity.h"

namespace robot_control {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Map = Eigen::Map<Vector3d>;

void PlainLegs::turn(const Input& input, State& state) noexcept {
  Map bias(state.bias.data());
  if (input.at_rest) bias += std::min(1.0, input.dt / kBiasTime) * (input.rate - bias);
  const Quaterniond before = quaternion_of(state.attitude);
  Vector3d turn = input.dt * (input.rate - bias);
  if (std::abs(input.force.norm() - kGravity) <= kBand) {
    const Vector3d up = before.conjugate() * Vector3d::UnitZ();
    turn += input.dt / (input.at_rest ? kTiltAtRest : kTilt) * input.force.normalized().cross(up);
  }
  store(before * turned_by(turn), state.attitude);
}

void PlainLegs::move(const Input& input, const FeetMotion& feet, const std::array<bool, kLegs>& stand,
                     State& state) noexcept {
  Vector3d sum = Vector3d::Zero();
  double count = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (!stand[leg]) continue;
    sum += feet.base_velocity[leg];
    count += 1;
  }
  Map velocity(state.velocity.data());
  if (count > 0) {
    velocity += std::min(1.0, input.dt / kSmooth) * (sum / count - velocity);
  } else if (!input.asked) {
    velocity.setZero();
  }
  Map(state.position.data()) += input.dt * (quaternion_of(state.attitude) * velocity);
}

}  // namespace robot_control
