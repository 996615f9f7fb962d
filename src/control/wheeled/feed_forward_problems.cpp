#include "control/wheeled/feed_forward_problems.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "control/wheeled/kinematics.h"
#include "signals/formatted_text.h"
#include "signals/roles.h"

namespace robot_control {

namespace {

constexpr const char* kProgram = program_of(Role::kController).data();

/// Holds one value of feed_forward and the value of the URDF.
struct MeasuredValue {
  const char* key;
  const char* unit;
  std::optional<double> given;
  double described;
  double max_factor;  ///< allowed factor between both
};

void check_plausible(const MeasuredValue& value, std::vector<std::string>& problems) {
  if (!value.given ||
      (*value.given <= value.max_factor * value.described && value.described <= value.max_factor * *value.given)) {
    return;
  }
  problems.push_back(formatted(
      "%s.feed_forward.%s = %.4g %s: the description says %.4g %s; more than %.4g times either way is taken for a "
      "typing error. Correct the one or the other.",
      kProgram, value.key, *value.given, value.unit, value.described, value.unit, value.max_factor));
}

/// Checks the torque that the joints take at full speed against the motors' torque and the description.
void check_joint_losses(const DriveControllerParameters& parameters, const DriveTrain& robot,
                        std::vector<std::string>& problems) {
  constexpr double kEffortShare = 0.25;   // of the effort limit: half of what a worm gear loses at full load
  constexpr double kDescribedFactor = 2;  // of the described value
  const DriveKinematics kinematics(robot);
  const double linear = parameters.max_linear_speed;
  const double angular = parameters.max_angular_speed;
  const PlanarTwist fastest{linear, angular};
  const WheelValues speeds = kinematics.joint_speeds(
      {kinematics.wheel_speed_scale(fastest) * linear, kinematics.wheel_speed_scale(fastest) * angular});
  double max_damping = std::numeric_limits<double>::infinity();
  double max_friction = max_damping;
  for (const WheelModel& wheel : robot.wheels) {
    const JointModel& joint = robot.joints[wheel.joint];
    const double speed = std::ranges::max(speeds, {}, [](double value) { return std::abs(value); });
    max_damping = std::min(
        max_damping, std::max(kDescribedFactor * joint.damping, kEffortShare * joint.effort_limit / std::abs(speed)));
    max_friction =
        std::min(max_friction, std::max(kDescribedFactor * joint.friction, kEffortShare * joint.effort_limit));
  }
  const auto check = [&](const char* key, const char* unit, const std::optional<double>& given, double limit,
                         const char* why) {
    if (!given || *given <= limit) return;
    problems.push_back(formatted(
        "%s.feed_forward.%s = %.4g %s: plausible for this robot are 0 … %.4g %s, %s, or twice what the description "
        "says. Where it really is more, say so in the URDF (<dynamics>).",
        kProgram, key, *given, unit, limit, unit, why));
  };
  check("wheel_damping", "N·m·s/rad", parameters.feed_forward.wheel_damping, max_damping,
        "a quarter of the wheel's torque limit at the fastest wheel speed of these limits");
  check("wheel_friction", "N·m", parameters.feed_forward.wheel_friction, max_friction,
        "a quarter of the wheel's torque limit");
}

}  // namespace

std::vector<std::string> feed_forward_problems(const DriveControllerParameters& parameters, const DriveTrain& robot) {
  std::vector<std::string> problems;
  const FeedForwardParameters& given = parameters.feed_forward;
  check_plausible({"mass", "kg", given.mass, robot.mass, 3}, problems);
  check_plausible({"yaw_inertia", "kg·m²", given.yaw_inertia, robot.yaw_inertia, 3}, problems);
  if (robot.wheels.empty()) return problems;
  const double wheel = robot.wheels.front().inertia;
  check_plausible({"wheel_inertia", "kg·m²", given.wheel_inertia, wheel, 30}, problems);
  check_joint_losses(parameters, robot, problems);
  return problems;
}

}  // namespace robot_control
