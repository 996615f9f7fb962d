#pragma once
/// The loop consists of roles. This table is the only place of the core that names the programs which play them.
///
/// A text such as "start {controller}" names the program of that role after `with_programs`.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace robot_control {

enum class Role : std::uint8_t { kDriver, kEstimator, kController, kMonitor, kTelemetry };

struct RoleNames {
  std::string_view role;
  std::string_view program;  ///< also the name of its node and of its block of parameters
};

/// The rows are in the order of Role.
inline constexpr std::array<RoleNames, 5> kRoles{{{"driver", "mujoco_plant"},
                                                  {"estimator", "state_estimator"},
                                                  {"controller", "diff_drive_controller"},
                                                  {"monitor", "safety_monitor"},
                                                  {"telemetry", "telemetry"}}};

constexpr std::string_view program_of(Role role) noexcept {
  return kRoles[static_cast<std::size_t>(role)].program;
}

/// Replaces each `place` in a text by a word that does not contain it.
inline std::string replaced(std::string text, std::string_view place, std::string_view word) {
  for (std::size_t at = 0; (at = text.find(place)) != std::string::npos;) text.replace(at, place.size(), word);
  return text;
}

/// Replaces each role in braces by what `name_of(Role)` returns.
template <typename NameOf>
std::string with_roles(std::string_view text, const NameOf& name_of) {
  std::string filled(text);
  for (std::size_t i = 0; i < kRoles.size(); ++i)
    filled = replaced(filled, "{" + std::string(kRoles[i].role) + "}", name_of(static_cast<Role>(i)));
  return filled;
}

/// Replaces each role in braces by its program.
inline std::string with_programs(std::string_view text) {
  return with_roles(text, [](Role role) { return program_of(role); });
}

}  // namespace robot_control
