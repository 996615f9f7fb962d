#pragma once

#include <array>
#include <cstddef>

#include "machine/machine_model.h"

namespace robot_control {

/// Returns "driven", "passive" or "held".
constexpr const char* name_of(JointRole role) noexcept {
  constexpr std::array<const char*, 3> kNames{"driven", "passive", "held"};
  return kNames[static_cast<std::size_t>(role)];
}

}  // namespace robot_control
