#include "loop/gate_setup.h"

#include <algorithm>
#include <string>

namespace robot_control {

std::vector<JointLimits> joint_limits(const MachineModel& robot) {
  std::vector<JointLimits> all;
  for (const JointModel& joint : robot.joints) {
    JointLimits limits{.effort = joint.effort_limit};
    if (joint.effort_rate > 0) limits.effort_rate = joint.effort_rate;
    if (joint.acceleration_limit > 0) limits.acceleration = joint.acceleration_limit;
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

namespace {

bool carries_out(const Driver& driver, StopKind kind) noexcept {
  const StopAction action{.kind = kind, .time = 1, .brake_after = 1};
  return driver.accepts(JointStop().step(action, std::nullopt, 0).mode) &&
         driver.accepts(JointStop().step(action, 0.0, 0).mode);
}

void require_stop_action(const Driver& driver, StopKind stop, const JointModel& joint) {
  if (carries_out(driver, stop)) return;
  std::string wanted = "move", possible;
  for (const Word& word : words_of(StopKind{})) {
    const auto kind = static_cast<StopKind>(word.value);
    if (kind == stop) wanted = word.text;
    if (carries_out(driver, kind)) possible.append(possible.empty() ? "" : " or ").append(word.text);
  }
  throw DriverError("joint " + joint.name + " must be stopped by the action \"" + wanted +
                    "\", which this driver does not implement. Set robot.fail_action to " + possible + ".");
}

struct NeedWords {
  const char* need;
  const char* remedy;
};

// In the order of JointMode and of MachineInput.
constexpr NeedWords kModeWords[] = {
    {"to brake", "add a brake law to the driver (gate/brake_law.h)"},
    {"commands of torques", "use drives that take torques, or set robot.wheel_command to velocity"},
    {"commands of velocities", "add the computation of torques to the driver (drivers/joint_law.h)"},
    {"commands of impedances", "add the computation of torques to the driver (drivers/joint_law.h)"},
    {"speeds that the drives control themselves (robot.wheel_command: velocity)",
     "use drives with a velocity mode, or set robot.wheel_command to torque"},
};
constexpr NeedWords kInputWords[] = {
    {"position and velocity of each joint", "use drives that measure them"},
    {"effort of each joint", "use drives that measure it, or set robot.wheel_command to velocity"},
    {"an IMU", "set robot.imu to topic and start the IMU's node, or use a driver with an IMU"},
    {"forces of contacts", "use a driver with contact sensors"},
};

}  // namespace

void require_stop_actions(const Driver& driver, const GateParameters& gate, const MachineModel& robot) {
  for (const StopProfile& profile : gate.profiles) {
    for (std::size_t i = 0; i < profile.size(); ++i) require_stop_action(driver, profile[i].kind, robot.joints.at(i));
  }
}

void require_needs(const Driver& driver, const MachineNeeds& needs) {
  std::string lacking;
  const auto add = [&lacking](const NeedWords& words) {
    lacking += std::string(lacking.empty() ? "" : "; ") + words.need + ": " + words.remedy;
  };
  for (const JointMode mode : needs.modes) {
    if (!driver.accepts(mode)) add(kModeWords[static_cast<std::size_t>(mode)]);
  }
  for (const MachineInput input : needs.inputs) {
    if (!driver.measures(input)) add(kInputWords[static_cast<std::size_t>(input)]);
  }
  if (!lacking.empty())
    throw DriverError("this kind of robot needs functions that its driver does not have: " + lacking);
}

}  // namespace robot_control
