#include "control/control_problems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include "control/feed_forward.h"
#include "control/measured_robot.h"
#include "control/wheel_loop_gains.h"
#include "control/wheel_loop_stability.h"

namespace robot_control {

namespace {

struct Load {
  const char* name;
  WheelLoad load;

  bool operator==(const Load& other) const noexcept { return load == other.load; }
};

std::array<Load, 4> loads(const RobotModel& robot, const WheelModel& wheel) {
  const double damping = robot.joints[wheel.joint].damping;
  const double straight = straight_inertia(robot, wheel);
  return {{{"lifted", {wheel.inertia, damping}},
           {"turning", {turning_inertia(robot, wheel), damping}},
           {"driving straight", {straight, damping}},
           {"driving straight with its mass doubled", {2 * straight - wheel.inertia, damping}}}};
}

/// What decides about stability.
struct Loop {
  WheelLoopGains gains;
  double bandwidth;  ///< Hz
  double period;     ///< s
  std::array<Load, 4> loads;

  bool operator==(const Loop& other) const noexcept {
    return gains.kp == other.gains.kp && gains.ki == other.gains.ki && loads == other.loads;
  }

  double radius(const Load& of) const { return wheel_loop_spectral_radius(gains, of.load, period, bandwidth); }

  /// Null: stable with every load.
  const Load* unstable_load() const {
    const auto found = std::ranges::find_if(loads, [&](const Load& load) { return !(radius(load) < 1); });
    return found == loads.end() ? nullptr : &*found;
  }
};

/// The largest common factor < 1 on all three gains, in steps of 2^(1/4), that is stable for every load; 0: none.
double stable_part(const Loop& loop) {
  constexpr double kStep = 0.8408964152537145;  // 2^(−1/4)
  constexpr int kSteps = 80;                    // down to a millionth
  Loop scaled = loop;
  double part = 1;
  for (int i = 0; i < kSteps; ++i) {
    part *= kStep;
    scaled.gains.kp = part * loop.gains.kp;
    scaled.gains.ki = part * loop.gains.ki;
    scaled.gains.kd = part * loop.gains.kd;
    if (scaled.unstable_load() == nullptr) return part;
  }
  return 0;
}

std::string unstable_message(const Loop& loop, const std::string& joint, const Load& load) {
  const WheelLoopGains& gains = loop.gains;
  std::ostringstream text;
  text.precision(3);
  text << "diff_drive_controller: pid_kp " << gains.kp << ", pid_ki " << gains.ki << ", pid_kd " << gains.kd
       << ", tracking_bandwidth " << loop.bandwidth << " Hz at " << std::lround(1 / loop.period)
       << " Hz: the loop of joint '" << joint << "' is unstable with the wheel " << load.name << " ("
       << load.load.inertia << " kg·m²): spectral radius " << loop.radius(load) << ", must be < 1. ";
  // Half of what is just stable: a gain margin of two.
  const double part = 0.5 * stable_part(loop);
  if (part > 0) {
    text << "Use at most pid_kp " << part * gains.kp << ", pid_ki " << part * gains.ki << ", pid_kd " << part * gains.kd
         << ", or leave pid_kp and pid_ki out: then they are derived from the robot.";
  } else {
    text
        << "No smaller gains of this proportion are stable: lower pid_ki or pid_kd against pid_kp, or leave pid_kp and "
           "pid_ki out: then they are derived from the robot.";
  }
  return text.str();
}

std::string powerless_message(const JointModel& joint, const RobotModel& robot) {
  std::ostringstream text;
  text << "joint '" << joint.name << "': effort limit " << joint.effort_limit
       << " N·m, must be > 0: the wheel could not be driven. Set <limit effort=…> in " << robot.source
       << ", or robot.wheel_effort_limit.";
  return text.str();
}

/// One value of feed_forward beside what the URDF says of it.
struct Believed {
  const char* key;
  const char* unit;
  std::optional<double> given;
  double described;
  double most;  ///< times either way
};

void check_believable(const Believed& value, std::vector<std::string>& problems) {
  if (!value.given || (*value.given <= value.most * value.described && value.described <= value.most * *value.given)) {
    return;
  }
  std::ostringstream text;
  text.precision(4);
  text << "diff_drive_controller.feed_forward." << value.key << " = " << *value.given << " " << value.unit << ": "
       << "the description says " << value.described << " " << value.unit << "; more than " << value.most
       << " times either way is taken for a slip of the pen. Correct the one or the other.";
  problems.push_back(text.str());
}

/// A payload, a rotor behind a gear: but not a hundred times what is described, which would drive the robot by itself.
void check_believable(const FeedForwardParameters& given, const RobotModel& robot, std::vector<std::string>& problems) {
  check_believable({"mass", "kg", given.mass, robot.mass, 5}, problems);
  check_believable({"yaw_inertia", "kg·m²", given.yaw_inertia, robot.yaw_inertia, 10}, problems);
  if (robot.wheels.empty()) return;
  const double wheel = robot.wheels.front().inertia;
  check_believable({"wheel_inertia", "kg·m²", given.wheel_inertia, wheel, 30}, problems);
}

}  // namespace

std::vector<std::string> control_problems(const DriveControllerParameters& parameters, const RobotModel& believed,
                                          double period) {
  const RobotModel robot = measured_robot(believed, parameters.feed_forward);
  std::vector<std::string> problems;
  check_believable(parameters.feed_forward, believed, problems);
  std::vector<Loop> judged;
  const double bandwidth = tracking_bandwidth(parameters, period);
  for (const WheelModel& wheel : robot.wheels) {
    const JointModel& joint = robot.joints[wheel.joint];
    if (!(joint.effort_limit > 0)) problems.push_back(powerless_message(joint, robot));
    const Loop loop{wheel_loop_gains(parameters, robot, wheel, period), bandwidth, period, loads(robot, wheel)};
    if (std::ranges::find(judged, loop) != judged.end()) continue;  // said of an equal wheel
    judged.push_back(loop);
    if (const Load* load = loop.unstable_load()) problems.push_back(unstable_message(loop, joint.name, *load));
  }
  return problems;
}

}  // namespace robot_control
