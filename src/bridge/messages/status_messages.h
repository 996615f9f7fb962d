#pragma once
/// Permits → words. Pure.

#include <cstdint>
#include <string>
#include <vector>

#include "bridge/messages/messages.h"
#include "bridge/messages/time_map.h"
#include "robot/robot_model.h"
#include "signals/permit.h"

namespace robot_control {

/// `absent`: nodes that do not run now; `period_ns` of the loop, for `since`; `robot` names the joints.
msg::SafetyStatus safety_status(const Permit& permit, const RobotModel& robot, const std::vector<std::string>& absent,
                                const TimeMap& time, std::int64_t period_ns);

/// What was measured of one cause: "17.3 rad/s, limit 15 rad/s, left_wheel_joint"; empty where nothing was.
std::string detail(const Permit& permit, std::uint64_t cause, const RobotModel& robot);

/// The status before the first permit: INIT, waiting for these nodes.
msg::SafetyStatus waiting_status(const std::vector<std::string>& missing);

/// Does `now` differ from `last` in more than cycle, stamp and measured values?
bool news(const Permit& last, const Permit& now);

/// Nodes that may be the reason of a refusal.
struct Publishers {
  std::vector<std::string> commands;  ///< on cmd_vel
  std::vector<std::string> e_stop;    ///< whose last message on e_stop was true
};

/// The answer to e_stop_reset: what it released, or why it was refused and what to do. `before`: the last permit
/// without the answer; `permit`: the one with it.
std::string reset_text(const Permit& before, const Permit& permit, const Publishers& publishers);

}  // namespace robot_control
