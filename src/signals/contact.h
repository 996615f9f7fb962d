#pragma once
/// A ContactSample holds the measured force of one contact of the machine with the ground, a ContactState its estimate.

#include <cstddef>
#include <cstdint>

#include "signals/geometry.h"

namespace robot_control {

inline constexpr std::size_t kMaxContacts = 8;

struct ContactSample {
  Vector3 force{};          ///< N, on the machine, base axes, mean over [t_k-1, t_k)
  std::uint64_t valid = 0;  ///< 1: the force was measured
};

struct ContactState {
  double probability = 0;  ///< 0 (no trusted contact) … 1 (trusted fully)
  double slip = 0;         ///< m/s, speed of the contact point over the ground, along the wheel
  double load = 0;         ///< N, its force upwards
};

}  // namespace robot_control
