#include "loop/gate_setup.h"

#include <algorithm>
#include <string>

namespace robot_control {

std::vector<JointLimits> joint_limits(const MachineModel& robot) {
  std::vector<JointLimits> all;
  for (const JointModel& joint : robot.joints) {
    JointLimits limits{.effort = joint.effort_limit};
    if (joint.effort_rate > 0) limits.effort_rate = joint.effort_rate;
    if (joint.velocity_limit > 0) limits.velocity = joint.velocity_limit;
    if (joint.range) {
      limits.lower = joint.range->lower;
      limits.upper = joint.range->upper;
      limits.soft_zone =
          std::min(kSoftPart * (limits.upper - limits.lower), joint.prismatic ? kSoftLength : kSoftAngle);
    }
    all.push_back(limits);
  }
  return all;
}

void require_stop_actions(const Driver& driver, const GateParameters& gate, const MachineModel& robot) {
  for (std::size_t i = 0; i < gate.stops.size(); ++i) {
    if (driver.implements(gate.stops[i].kind)) continue;
    std::string wanted = "fold", possible;
    for (const Word& word : words_of(StopKind{})) {
      const auto kind = static_cast<StopKind>(word.value);
      if (kind == gate.stops[i].kind) wanted = word.text;
      if (driver.implements(kind)) possible.append(possible.empty() ? "" : " or ").append(word.text);
    }
    throw DriverError("joint " + robot.joints.at(i).name + " is to be stopped by the action \"" + wanted +
                      "\", which this driver does not implement. Set robot.fail_action to " + possible + ".");
  }
}

}  // namespace robot_control
