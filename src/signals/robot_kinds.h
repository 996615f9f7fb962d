#pragma once
/// A robot kind has a controller program of its own. The other roles are played by the same programs on any robot
/// (signals/roles.h).

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "signals/roles.h"

namespace robot_control {

struct KindNames {
  std::string_view kind;
  std::string_view controller;  ///< program, and name of its node and of its block of parameters
};

inline constexpr std::string_view kWheeledKind = "differential_drive";
inline constexpr std::string_view kLeggedKind = "quadruped";
inline constexpr std::array<KindNames, 2> kKinds{
    {{kWheeledKind, program_of(Role::kController)}, {kLeggedKind, "leg_controller"}}};

/// Returns the program of a role on a robot of this kind. A kind that is not in the table has the first controller.
constexpr std::string_view program_of(Role role, std::string_view kind) noexcept {
  if (role == Role::kController) {
    for (const KindNames& row : kKinds) {
      if (row.kind == kind) return row.controller;
    }
  }
  return program_of(role);
}

/// Replaces each role in braces by its program on a robot of this kind.
inline std::string with_programs(std::string_view text, std::string_view kind) {
  std::string filled(text);
  const std::string place = "{" + std::string(kRoles[static_cast<std::size_t>(Role::kController)].role) + "}";
  for (std::size_t at = 0; (at = filled.find(place)) != std::string::npos;) {
    filled.replace(at, place.size(), program_of(Role::kController, kind));
  }
  return with_programs(filled);
}

}  // namespace robot_control
