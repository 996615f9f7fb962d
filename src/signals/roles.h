#pragma once
/// The loop consists of roles. This table is the only place of the core that names the programs which play them.

#include <array>
#include <cstddef>
#include <cstdint>
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

}  // namespace robot_control
