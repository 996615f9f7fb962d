#include "control/feed_forward_problems.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "control/kinematics.h"

namespace robot_control {

namespace {

/// One value of feed_forward beside what the URDF says of it.
struct MeasuredValue {
  const char* key;
  const char* unit;
  std::optional<double> given;
  double described;
  double most;  ///< times either way
};

void check_plausible(const MeasuredValue& value, std::vector<std::string>& problems) {
  if (!value.given || (*value.given <= value.most * value.described && value.described <= value.most * *value.given)) {
    return;
  }
  std::ostringstream text;
  text.precision(4);
  text << "diff_drive_controller.feed_forward." << value.key << " = " << *value.given << " " << value.unit << ": "
       << "the description says " << value.described << " " << value.unit << "; more than " << value.most
       << " times either way is taken for a typing error. Correct the one or the other.";
  problems.push_back(text.str());
}

/// What the joints take at full speed by the set, beside what the motors have and what the description says.
void check_joint_losses(const DriveControllerParameters& parameters, const RobotModel& robot,
                        std::vector<std::string>& problems) {
  constexpr double kPart = 0.25;  // of the effort limit, for bearing and gear: half of a worm gear's at full load
  constexpr double kTimes = 2;    // of what is described
  const DriveKinematics kinematics(robot);
  const double linear = parameters.max_linear_speed;
  const double angular = parameters.max_angular_speed;
  const PlanarTwist fastest{linear, angular};
  const WheelValues speeds = kinematics.joint_speeds(
      {kinematics.wheel_speed_scale(fastest) * linear, kinematics.wheel_speed_scale(fastest) * angular});
  double most_damping = std::numeric_limits<double>::infinity();
  double most_friction = most_damping;
  for (const WheelModel& wheel : robot.wheels) {
    const JointModel& joint = robot.joints[wheel.joint];
    const double speed = std::ranges::max(speeds, {}, [](double value) { return std::abs(value); });
    most_damping =
        std::min(most_damping, std::max(kTimes * joint.damping, kPart * joint.effort_limit / std::abs(speed)));
    most_friction = std::min(most_friction, std::max(kTimes * joint.friction, kPart * joint.effort_limit));
  }
  const auto check = [&](const char* key, const char* unit, const std::optional<double>& given, double most,
                         const char* why) {
    if (!given || *given <= most) return;
    std::ostringstream text;
    text.precision(4);
    text << "diff_drive_controller.feed_forward." << key << " = " << *given << " " << unit
         << ": plausible for this robot are 0 … " << most << " " << unit << ", " << why
         << ", or twice what the description says. Where it really is more, say so in the URDF (<dynamics>).";
    problems.push_back(text.str());
  };
  check("wheel_damping", "N·m·s/rad", parameters.feed_forward.wheel_damping, most_damping,
        "a quarter of the wheel's torque limit at the fastest wheel speed of these limits");
  check("wheel_friction", "N·m", parameters.feed_forward.wheel_friction, most_friction,
        "a quarter of the wheel's torque limit");
}

}  // namespace

std::vector<std::string> feed_forward_problems(const DriveControllerParameters& parameters, const RobotModel& robot) {
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
