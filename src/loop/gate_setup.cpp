#include "loop/gate_setup.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

std::vector<JointLimits> joint_limits(const MachineModel& robot) {
  std::vector<JointLimits> all;
  for (const JointModel& joint : robot.joints) {
    JointLimits limits{.effort = joint.effort_limit, .wheel = joint.role == JointRole::kDriven};
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

GateParameters gate_parameters(const Parameters& parameters) {
  const double ramp = std::ceil(parameters.safety.ramp_time / parameters.loop.period() - 1e-9);
  return {.fail_action = parameters.loop.fail_action,
          .longest_ramp = static_cast<std::uint64_t>(ramp) + parameters.safety.loss_cycles};
}

}  // namespace robot_control
