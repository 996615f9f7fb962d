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
  std::string_view request;     ///< topics of requests of motion, in words
  std::string_view timeout;     ///< parameter with the time after which a request of a silent sender ends
  std::string_view begin;       ///< what lets the robot move, after "ready: "
};

inline constexpr std::string_view kWheeledKind = "differential_drive";
inline constexpr std::string_view kLeggedKind = "quadruped";
inline constexpr std::array<KindNames, 2> kKinds{
    {{kWheeledKind, program_of(Role::kController), "cmd_vel", "cmd_vel_timeout", "send cmd_vel"},
     {kLeggedKind, "leg_controller", "cmd_vel or body_pose", "request_timeout", "send cmd_vel, or call set_posture"}}};

/// Returns the row of this kind. A kind that is not in the table has the first one.
constexpr const KindNames& names_of_kind(std::string_view kind) noexcept {
  for (const KindNames& row : kKinds) {
    if (row.kind == kind) return row;
  }
  return kKinds.front();
}

/// The programs that play the roles on one robot. Its kind chooses the controller, robot.driver the driver.
struct Programs {
  std::string_view kind = kWheeledKind;
  std::string_view driver = program_of(Role::kDriver);
};

constexpr std::string_view program_of(Role role, const Programs& programs) noexcept {
  if (role == Role::kDriver) return programs.driver;
  return role == Role::kController ? names_of_kind(programs.kind).controller : program_of(role);
}

/// Replaces each role in braces, as in "start {controller}", by what `name_of(Role)` returns; {request} and
/// {request_timeout} by the names of the kind.
template <typename NameOf>
std::string with_names(std::string_view text, std::string_view kind, const NameOf& name_of) {
  std::string filled(text);
  const auto replace = [&](std::string_view word, std::string_view name) {
    const std::string place = "{" + std::string(word) + "}";
    for (std::size_t at = 0; (at = filled.find(place)) != std::string::npos;) filled.replace(at, place.size(), name);
  };
  for (std::size_t i = 0; i < kRoles.size(); ++i) replace(kRoles[i].role, name_of(static_cast<Role>(i)));
  replace("request", names_of_kind(kind).request);
  replace("request_timeout", names_of_kind(kind).timeout);
  return filled;
}

/// Replaces each role in braces by its program on this robot.
inline std::string with_programs(std::string_view text, const Programs& programs) {
  return with_names(text, programs.kind, [&](Role role) { return program_of(role, programs); });
}

}  // namespace robot_control
