#pragma once
/// The list of command sources is a YAML file with the keys of twist_mux (wiki.ros.org/twist_mux).
///
///   topics:                  # at least one
///     - name: joystick       # [a-z0-9_], unique
///       topic: joy_vel       # relative names follow the namespace
///       timeout: 0.5         # s after which the source is silent; 0: never
///       priority: 40         # 0 … 255, unique; the highest source that is not silent commands
///       stamped: false       # true: TwistStamped
///   locks:                   # may be left out; std_msgs/Bool
///     - name: pause
///       topic: pause
///       timeout: 0           # s after which silence also locks; 0: only `true` locks
///       priority: 255        # masks every source of a lower priority

#include <cstdint>
#include <string>
#include <vector>

namespace robot_control {

struct CommandLock {
  std::string name;
  std::string topic;
  double timeout = 0;  ///< s; 0: silence does not lock
  std::int64_t priority = 0;
};

/// The timeout 0 of a source means never.
struct CommandSource : CommandLock {
  bool stamped = false;
};

struct CommandSourceList {
  std::vector<CommandSource> sources;  ///< by priority, the highest first
  std::vector<CommandLock> locks;
};

/// Throws ParameterError with all problems of the file.
CommandSourceList read_command_sources(const std::string& path);

}  // namespace robot_control
