#pragma once
/// These functions convert permits to words. They are pure.

#include <robot_control/RobotKind.h>
#include <robot_control/SafetyStatus.h>

#include <cstdint>
#include <string>
#include <vector>

#include "machine/machine_model.h"
#include "ros/messages/time_map.h"
#include "signals/permit.h"
#include "signals/robot_kinds.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// `absent` are the nodes that do not run now. `period_ns` is the loop's period for the field `since`. `robot` names
/// the joints, and `programs` those of remedies.
SafetyStatus safety_status(const Permit& permit, const MachineModel& robot, const std::vector<std::string>& absent,
                           const TimeMap& time, std::int64_t period_ns, const Programs& programs);

/// Adds the warning `torque_not_measured`, which names the conditions that are blind without a torque, where a drive
/// measures its motion and no torque.
void warn_of_blind_conditions(const SensorFrame& sensors, SafetyStatus& status);

/// Returns what tools need to know of a robot. `injects` says that its machine is simulated and takes faults.
RobotKind robot_kind(const MachineModel& robot, const Programs& programs, bool injects);

/// Returns the evidence of a cause, "17.3 rad/s, limit 15 rad/s, left_wheel_joint"; "" if nothing was measured.
std::string detail(const Permit& permit, std::uint64_t cause, const MachineModel& robot);

/// Returns the status before the first permit: the state is INIT, and the monitor waits for these nodes.
SafetyStatus waiting_status(const std::vector<std::string>& missing);

/// Returns whether `now` differs from `last` in more than cycle, stamp and measured values.
bool differs(const Permit& last, const Permit& now);

/// These nodes may be the reason why a reset is refused.
struct Publishers {
  std::vector<std::string> commands;  ///< on cmd_vel
  std::vector<std::string> e_stop;    ///< those whose last message on e_stop was true
};

/// Returns the answer to e_stop_reset: the causes that it released, or why it was refused and the remedy. `before` is
/// the last permit before the reset, `permit` the first one with its result.
std::string reset_text(const Permit& before, const Permit& permit, const Publishers& publishers,
                       const Programs& programs);

}  // namespace robot_control
