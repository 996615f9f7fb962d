#pragma once
/// A ContactSample holds the measured force of one contact of the machine with the ground, a ContactState its estimate.
/// The ContactSchedule says what the controller asks of each contact.

#include <array>
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

/// Each number belongs to the contact of the same index. It is 0 if the contact shall not bear, and 0.5 if it bears
/// without a schedule. Otherwise it is the part of its time on the ground that is over at the end of this cycle, above
/// 0 … 1.
using ContactSchedule = std::array<double, kMaxContacts>;

}  // namespace robot_control
