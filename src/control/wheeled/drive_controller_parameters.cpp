#include "control/wheeled/drive_controller_parameters.h"

#include "control/wheeled/limits/drive_limits.h"

namespace robot_control {
namespace {

/// `max` is the path of the axis's limits without the end of their names.
void check_axis(const std::string& max, const MotionLimits& limits, bool own_deceleration, std::optional<double> jerk,
                GivenValues& given) {
  const std::string emergency = max + "_emergency_deceleration";
  const auto require = [&](const std::string& usual, double deceleration) {
    if (!given.accepted(emergency) || !given.accepted(usual) || limits.emergency_deceleration >= deceleration) return;
    given.refuse(emergency, "must not be below " + given.shown(usual));
  };
  require(max + (own_deceleration ? "_deceleration" : "_acceleration"), limits.deceleration);
  require(max + "_deceleration_reverse", limits.deceleration_from(-1));
  // The jerk limit must allow the emergency deceleration to build up.
  constexpr double kBuildUp = 1.0;  // s
  if (!given.accepted(max + "_jerk") || jerk.value_or(0) == 0) return;
  if (*jerk * kBuildUp >= limits.emergency_deceleration) return;
  const std::string derived = emergency + " = " + shortest(limits.emergency_deceleration) + " (derived)";
  given.refuse(max + "_jerk", "must be 0 (off) or reach " +
                                  (given.accepted(emergency) ? given.shown(emergency) : derived) + " within " +
                                  shortest(kBuildUp) + " s");
}

}  // namespace

void check(const DriveControllerParameters& parameters, const std::string& block, GivenValues& given) {
  const SpeedLimits limits = speed_limits(parameters);
  check_axis(block + ".max_linear", limits.linear, parameters.max_linear_deceleration.has_value(),
             parameters.max_linear_jerk, given);
  check_axis(block + ".max_angular", limits.angular, parameters.max_angular_deceleration.has_value(),
             parameters.max_angular_jerk, given);
}

}  // namespace robot_control
