#include "control/control_problems.h"

#include <array>
#include <cmath>
#include <sstream>

#include "control/feed_forward.h"
#include "control/wheel_loop_stability.h"

namespace robot_control {

namespace {

struct Load {
  const char* name;
  double inertia;  ///< kg·m²

  bool operator==(const Load& other) const noexcept { return inertia == other.inertia; }
};

std::array<Load, 4> loads(const RobotModel& robot, const WheelModel& wheel) {
  const double straight = straight_inertia(robot, wheel);
  return {{{"lifted", wheel.inertia},
           {"turning", turning_inertia(robot, wheel)},
           {"driving straight", straight},
           {"driving straight with its mass doubled", 2 * straight - wheel.inertia}}};
}

const Load* unstable_load(const WheelLoopGains& gains, const std::array<Load, 4>& candidates, double period,
                          double bandwidth) {
  for (const Load& load : candidates) {
    if (!(wheel_loop_spectral_radius(gains, load.inertia, period, bandwidth) < 1)) return &load;
  }
  return nullptr;
}

/// The largest common factor < 1 on all three gains, in steps of 2^(1/4), that is stable for every load; 0: none.
double stable_part(const WheelLoopGains& gains, const std::array<Load, 4>& candidates, double period,
                   double bandwidth) {
  constexpr double kStep = 0.8408964152537145;  // 2^(−1/4)
  constexpr int kSteps = 80;                    // down to a millionth
  double part = 1;
  for (int i = 0; i < kSteps; ++i) {
    part *= kStep;
    const WheelLoopGains scaled{part * gains.kp, part * gains.ki, part * gains.kd, gains.model_inertia};
    if (!unstable_load(scaled, candidates, period, bandwidth)) return part;
  }
  return 0;
}

std::string unstable_message(const DriveControllerParameters& parameters, const std::string& joint, const Load& load,
                             double radius, double part, double period) {
  // Half of what is just stable: a gain margin of two.
  std::ostringstream text;
  text.precision(3);
  text << "diff_drive_controller: pid_kp " << parameters.pid_kp << ", pid_ki " << parameters.pid_ki << ", pid_kd "
       << parameters.pid_kd << ", tracking_bandwidth " << parameters.tracking_bandwidth << " Hz at "
       << std::lround(1 / period) << " Hz: the loop of joint '" << joint << "' is unstable with the wheel " << load.name
       << " (" << load.inertia << " kg·m²): spectral radius " << radius << ", must be < 1. ";
  if (part > 0) {
    text << "Use at most pid_kp " << 0.5 * part * parameters.pid_kp << ", pid_ki " << 0.5 * part * parameters.pid_ki
         << ", pid_kd " << 0.5 * part * parameters.pid_kd << ", or a higher rate.";
  } else {
    text << "No smaller gains of this proportion are stable: lower pid_ki or pid_kd against pid_kp, or use a higher "
            "rate.";
  }
  return text.str();
}

}  // namespace

WheelLoopGains wheel_loop_gains(const DriveControllerParameters& parameters, const WheelModel& wheel) noexcept {
  return {parameters.pid_kp, parameters.pid_ki, parameters.pid_kd, kModelInertiaFactor * wheel.inertia};
}

std::vector<std::string> control_problems(const DriveControllerParameters& parameters, const RobotModel& robot,
                                          double period) {
  std::vector<std::string> problems;
  for (const WheelModel* wheel : {&robot.left, &robot.right}) {
    const JointModel& joint = robot.joints[wheel->joint];
    if (!(joint.effort_limit > 0)) {
      std::ostringstream text;
      text << "joint '" << joint.name << "': effort limit " << joint.effort_limit
           << " N·m, must be > 0: the wheel could not be driven. Set <limit effort=…> in " << robot.source << ".";
      problems.push_back(text.str());
    }
    const std::array<Load, 4> candidates = loads(robot, *wheel);
    if (wheel == &robot.right && candidates == loads(robot, robot.left)) continue;  // said of the left one
    const WheelLoopGains gains = wheel_loop_gains(parameters, *wheel);
    const double bandwidth = parameters.tracking_bandwidth;
    if (const Load* load = unstable_load(gains, candidates, period, bandwidth)) {
      const double radius = wheel_loop_spectral_radius(gains, load->inertia, period, bandwidth);
      problems.push_back(unstable_message(parameters, joint.name, *load, radius,
                                          stable_part(gains, candidates, period, bandwidth), period));
    }
  }
  return problems;
}

}  // namespace robot_control
