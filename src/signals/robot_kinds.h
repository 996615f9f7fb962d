#pragma once
/// A robot kind has a controller program of its own, and topics of its own for requests of motion. The other roles are
/// played by the same programs on any robot (signals/roles.h).

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "signals/roles.h"

namespace robot_control {

struct KindNames {
  std::string_view kind;
  std::string_view controller;  ///< program, and name of its node and of its block of parameters
  std::string_view request;     ///< topic of requests of motion
  std::string_view timeout;     ///< parameter with the time after which a request of a silent sender ends
  std::string_view begin;       ///< what lets the robot move, after "ready: "
};

inline constexpr std::string_view kWheeledKind = "differential_drive";
inline constexpr std::string_view kLeggedKind = "quadruped";
inline constexpr std::array<KindNames, 2> kKinds{
    {{kWheeledKind, program_of(Role::kController), "cmd_vel", "cmd_vel_timeout", "send cmd_vel"},
     {kLeggedKind, "leg_controller", "body_pose", "request_timeout", "call set_posture"}}};

/// Returns the row of this kind. A kind that is not in the table has the first one.
constexpr const KindNames& names_of_kind(std::string_view kind) noexcept {
  for (const KindNames& row : kKinds) {
    if (row.kind == kind) return row;
  }
  return kKinds.front();
}

/// Returns the program of a role on a robot of this kind.
constexpr std::string_view program_of(Role role, std::string_view kind) noexcept {
  return role == Role::kController ? names_of_kind(kind).controller : program_of(role);
}

/// Replaces each role in braces by its program on a robot of this kind, and so {request} and {request_timeout}.
inline std::string with_programs(std::string_view text, std::string_view kind) {
  const KindNames& names = names_of_kind(kind);
  std::string filled(text);
  filled = replaced(filled, "{" + std::string(kRoles[static_cast<std::size_t>(Role::kController)].role) + "}",
                    names.controller);
  filled = replaced(filled, "{request}", names.request);
  filled = replaced(filled, "{request_timeout}", names.timeout);
  return with_programs(filled);
}

}  // namespace robot_control
