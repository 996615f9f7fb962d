#include "control/wheeled/control_problems.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "control/wheeled/feed_forward_problems.h"
#include "control/wheeled/measured_robot.h"
#include "control/wheeled/wheel_loops/feed_forward.h"
#include "control/wheeled/wheel_loops/quantisation_ripple.h"
#include "control/wheeled/wheel_loops/wheel_loop_gains.h"
#include "control/wheeled/wheel_loops/wheel_loop_stability.h"
#include "machine/suspicions.h"
#include "signals/formatted_text.h"
#include "signals/roles.h"

namespace robot_control {

namespace {

constexpr const char* kController = program_of(Role::kController).data();

struct Load {
  const char* name;
  bool driven;  ///< a load that the robot drives with, on its wheels
  WheelLoad load;

  bool operator==(const Load& other) const noexcept { return load == other.load; }
};

using Loads = std::array<Load, 8>;

/// Returns the loads of a wheel, first as the set has it and then as the robot's description has it.
Loads loads(const DriveTrain& set, const DriveTrain& described, std::size_t wheel) {
  Loads loads{};
  auto next = loads.begin();
  for (const DriveTrain* robot : {&set, &described}) {
    const WheelModel& model = robot->wheels[wheel];
    const double damping = robot->joints[model.joint].damping;
    const double straight = straight_inertia(*robot, model);
    *next++ = {"lifted", false, {model.inertia, damping}};
    *next++ = {"turning", true, {turning_inertia(*robot, model), damping}};
    *next++ = {"driving straight", true, {straight, damping}};
    *next++ = {"driving straight with its mass doubled", false, {2 * straight - model.inertia, damping}};
  }
  return loads;
}

/// Every mode of the wheel loop needs this damping ratio with a load that the robot drives. With the wheel lifted or
/// the mass doubled it needs kMinDampingOff. Derived gains have 0.5 … 0.6 and 0.28 … 0.4 at 1 kHz.
constexpr double kMinDamping = 0.3;
constexpr double kMinDampingOff = 0.2;

/// This limits `tracking_bandwidth` times the period. Within a cycle the loop then moves by 2π·0.1 of the distance to a
/// new count. Above it, wheel speeds are the encoder's counts, from which the loop makes torque.
constexpr double kMaxTracking = 0.1;

/// `pid_kp` and `tracking_bandwidth` must be at least this share of the derived values.
constexpr double kMinShare = 0.1;

/// This limits the RMS of the torque of a lifted wheel behind an encoder, over the torque limit. The safety monitor
/// stops more in the end.
constexpr double kMaxRipple = 0.3;

/// A set is not refused if derived gains are nearly as bad.
constexpr double kDerivedFactor = 1.2;

/// Counts are judged at these shares of full speed.
constexpr std::array kSpeedParts{1.0, 0.3, 0.1, 0.03};

/// Holds the values that decide about stability.
struct Loop {
  WheelLoopGains gains;
  double bandwidth;     ///< Hz
  double period;        ///< s
  double effort_limit;  ///< N·m
  double speed;         ///< rad/s, fastest speed
  Loads loads;          ///< loads of the set, then those of the description

  bool operator==(const Loop& other) const noexcept {
    return gains.kp == other.gains.kp && gains.ki == other.gains.ki && effort_limit == other.effort_limit &&
           speed == other.speed && loads == other.loads;
  }

  double radius(const Load& load) const { return wheel_loop_spectral_radius(gains, load.load, period, bandwidth); }

  double damping(const Load& load) const { return wheel_loop_damping_ratio(gains, load.load, period, bandwidth); }

  /// Returns the damping ratio that `load` needs, at most nine tenths of what `derived`, the loop of derived gains,
  /// has.
  static double least_damping(const Loop& derived, const Load& load) {
    return std::min(load.driven ? kMinDamping : kMinDampingOff, 0.9 * derived.damping(load));
  }

  /// Returns the first load with too little damping; null: none.
  const Load* underdamped_load(const Loop& derived) const {
    const auto found =
        std::ranges::find_if(loads, [&](const Load& load) { return damping(load) < least_damping(derived, load); });
    return found == loads.end() ? nullptr : &*found;
  }

  /// Returns the largest RMS of the torque at any of kSpeedParts, over the torque limit.
  double ripple(const Load& load) const {
    double largest = 0;
    for (const double part : kSpeedParts)
      largest = std::max(largest, quantisation_ripple(gains, load.load, bandwidth, effort_limit, part * speed, period));
    return largest / effort_limit;
  }

  /// Returns the lifted wheel, of the set or of the description, whose torque oscillates; null: none.
  const Load* oscillating_load(const Loop& derived) const {
    for (const Load* lifted : {loads.data(), loads.data() + loads.size() / 2}) {
      const double part = ripple(*lifted);
      if (part > kMaxRipple && part > kDerivedFactor * derived.ripple(*lifted)) return lifted;
    }
    return nullptr;
  }

  /// Returns the first unstable load; null: none.
  const Load* unstable_load() const {
    const auto found = std::ranges::find_if(loads, [&](const Load& load) { return !(radius(load) < 1); });
    return found == loads.end() ? nullptr : &*found;
  }
};

constexpr double kStep = 0.8408964152537145;  // 2^(−1/4)
constexpr int kSteps = 80;                    // steps down to a millionth

/// Returns the largest factor f < 1, in steps of 2^(1/4), with which f·kp, f²·ki and f·kd are stable and damped for
/// every load; 0: none.
double stable_part(const Loop& loop, const Loop& derived) {
  Loop scaled = loop;
  double part = 1;
  for (int i = 0; i < kSteps; ++i) {
    part *= kStep;
    scaled.gains.kp = part * loop.gains.kp;
    scaled.gains.ki = part * part * loop.gains.ki;
    scaled.gains.kd = part * loop.gains.kd;
    if (scaled.unstable_load() == nullptr && scaled.underdamped_load(derived) == nullptr) return part;
  }
  return 0;
}

/// Returns the largest pid_ki below the loop's, in the same steps, that damps every load enough; 0: none.
double damped_ki(const Loop& loop, const Loop& derived) {
  Loop scaled = loop;
  for (int i = 0; i < kSteps; ++i) {
    scaled.gains.ki *= kStep;
    if (scaled.underdamped_load(derived) == nullptr) return scaled.gains.ki;
  }
  return 0;
}

/// Returns true if the load is that of the described robot and differs from that of the set.
bool described(const Loop& loop, const Load& load) {
  const auto place = static_cast<std::size_t>(&load - loop.loads.data());
  const std::size_t half = loop.loads.size() / 2;
  return place >= half && !(loop.loads[place] == loop.loads[place - half]);
}

/// Returns "lifted (0.01 kg·m²)".
std::string load_words(const Loop& loop, const Load& load) {
  return formatted("%s (%.3g kg·m²%s)", load.name, load.load.inertia,
                   described(loop, load) ? " by the description" : "");
}

std::string unstable_message(const Loop& loop, const Loop& derived, const std::string& joint, const Load& load) {
  const WheelLoopGains& gains = loop.gains;
  const std::string problem = formatted(
      "%s: pid_kp %.3g, pid_ki %.3g, pid_kd %.3g, tracking_bandwidth %.3g Hz at %ld Hz. The loop of joint '%s' is "
      "unstable with the wheel %s: spectral radius %.3g, must be < 1. ",
      kController, gains.kp, gains.ki, gains.kd, loop.bandwidth, std::lround(1 / loop.period), joint.c_str(),
      load_words(loop, load).c_str(), loop.radius(load));
  const double part = stable_part(loop, derived);
  if (part <= 0) {
    return problem +
           "No smaller gains of this proportion are stable. Reduce pid_ki or pid_kd against pid_kp, or remove pid_kp "
           "and pid_ki: then they are derived from the robot.";
  }
  return problem + formatted(
                       "Set at most pid_kp %.3g, pid_ki %.3g, pid_kd %.3g, or remove pid_kp and pid_ki: then they are "
                       "derived from the robot.",
                       part * gains.kp, part * part * gains.ki, part * gains.kd);
}

std::string underdamped_message(const Loop& loop, const Loop& derived, const std::string& joint, const Load& load) {
  const double limit = damped_ki(loop, derived);
  return formatted(
             "%s: pid_kp %.3g, pid_ki %.3g, pid_kd %.3g, tracking_bandwidth %.3g Hz. The loop of joint '%s' oscillates "
             "with the wheel %s: damping ratio %.3g, must be at least %.3g. ",
             kController, loop.gains.kp, loop.gains.ki, loop.gains.kd, loop.bandwidth, joint.c_str(),
             load_words(loop, load).c_str(), loop.damping(load), Loop::least_damping(derived, load)) +
         (limit > 0
              ? formatted("Set at most pid_ki %.3g", limit)
              : formatted("Reduce pid_kp and pid_kd, or set tracking_bandwidth nearer to %.3g Hz", derived.bandwidth)) +
         "; or remove them: then they are derived from the robot.";
}

std::string oscillation_message(const Loop& loop, const Loop& derived, const std::string& joint, const Load& load) {
  return formatted(
      "%s: pid_kp %.3g, pid_kd %.3g, tracking_bandwidth %.3g Hz: behind an encoder of %d counts the torque of joint "
      "'%s' oscillates by %.3g of its limit, RMS, with the wheel %s, must be at most %.3g. Lower tracking_bandwidth, "
      "derived are %.3g Hz, or pid_kp and pid_kd; or leave them out: then they are derived from the robot.",
      kController, loop.gains.kp, loop.gains.kd, loop.bandwidth, kCounts, joint.c_str(), loop.ripple(load),
      load_words(loop, load).c_str(), kMaxRipple, derived.bandwidth);
}

std::string tracking_message(double bandwidth, double limit, double period) {
  return formatted(
      "%s.tracking_bandwidth = %.3g Hz: must be at most %.3g Hz, %.3g of the rate of %ld Hz: above, wheel speeds "
      "follow the encoder's counts. Leave it out: then it is derived from the rate.",
      kController, bandwidth, limit, kMaxTracking, std::lround(1 / period));
}

std::string weak_message(const std::string& key, double value, double derived, const char* unit) {
  return formatted(
      "%s.%s = %.3g %s: must be at least %.3g %s, a tenth of what is derived from the robot: below, the wheels follow "
      "feed_forward alone. Raise it, or leave it out: then it is derived.",
      kController, key.c_str(), value, unit, kMinShare * derived, unit);
}

std::string powerless_message(const JointModel& joint, const DriveTrain& robot) {
  return "joint '" + joint.name + "'" + formatted(": effort limit %g N·m", joint.effort_limit) +
         ", must be > 0: the wheel could not be driven. Set <limit effort=…> in " + robot.source +
         ", or robot.wheel_effort_limit.";
}

void add_unused_gains(const DriveControllerParameters& parameters, std::vector<std::string>& problems) {
  const auto add = [&](const char* key, double value) {
    problems.push_back(
        formatted("%s.%s = %g: has no effect with robot.wheel_command: velocity, because the drives close the wheel "
                  "loops. Leave it out, or set robot.wheel_command to torque.",
                  kController, key, value));
  };
  if (parameters.pid_kp) add("pid_kp", *parameters.pid_kp);
  if (parameters.pid_ki) add("pid_ki", *parameters.pid_ki);
  if (parameters.pid_kd != 0) add("pid_kd", parameters.pid_kd);
}

/// Returns true if nothing but limits is set: the rest is derived from the description.
bool only_limits(const DriveControllerParameters& parameters) noexcept {
  const FeedForwardParameters& given = parameters.feed_forward;
  return !parameters.pid_kp && !parameters.pid_ki && parameters.pid_kd == 0 && !parameters.tracking_bandwidth &&
         !given.mass && !given.yaw_inertia && !given.wheel_inertia && !given.wheel_damping && !given.wheel_friction;
}

void check_loops(const DriveControllerParameters& parameters, const DriveTrain& described, const DriveTrain& set,
                 double period, std::vector<std::string>& problems) {
  std::vector<Loop> judged;
  const bool gains_are_set = !only_limits(parameters);
  for (std::size_t i = 0; i < set.wheels.size(); ++i) {
    const WheelModel& wheel = set.wheels[i];
    const JointModel& joint = set.joints[wheel.joint];
    if (!(joint.effort_limit > 0)) problems.push_back(powerless_message(joint, set));
    const Loop loop{wheel_loop_gains(parameters, set, wheel, period),
                    tracking_bandwidth(parameters, period),
                    period,
                    joint.effort_limit,
                    parameters.max_linear_speed / wheel.radius,
                    loads(set, described, i)};
    Loop derived = loop;
    derived.gains = wheel_loop_gains({}, described, described.wheels[i], period);
    derived.bandwidth = tracking_bandwidth({}, period);
    if (std::ranges::find(judged, loop) != judged.end()) continue;  // An equal wheel has been judged.
    judged.push_back(loop);
    if (loop.gains.kp < kMinShare * derived.gains.kp) {
      problems.push_back(weak_message("pid_kp", loop.gains.kp, derived.gains.kp, "N·m·s/rad"));
    }
    if (const Load* load = loop.unstable_load()) {
      const std::string suspicions = suspicions_of(described);
      problems.push_back(unstable_message(loop, derived, joint.name, *load) +
                         (suspicions.empty() ? "" : " " + suspicions));
    } else if (const Load* swinging = loop.underdamped_load(derived)) {
      problems.push_back(underdamped_message(loop, derived, joint.name, *swinging));
    } else if (const Load* shaken = gains_are_set ? loop.oscillating_load(derived) : nullptr) {
      problems.push_back(oscillation_message(loop, derived, joint.name, *shaken));
    }
  }
}

}  // namespace

std::vector<std::string> control_problems(const DriveControllerParameters& parameters, const DriveTrain& described,
                                          double period) {
  const DriveTrain robot = measured_robot(described, parameters.feed_forward);
  std::vector<std::string> problems = feed_forward_problems(parameters, described);
  const bool drives_close_loops = robot.wheel_command == WheelCommand::kVelocity;
  if (drives_close_loops) add_unused_gains(parameters, problems);
  const double bandwidth = tracking_bandwidth(parameters, period);
  const double limit = std::max(kMaxTracking / period, tracking_bandwidth({}, period));
  if (bandwidth > limit) problems.push_back(tracking_message(bandwidth, limit, period));
  if (const double derived = tracking_bandwidth({}, period); bandwidth < kMinShare * derived) {
    problems.push_back(weak_message("tracking_bandwidth", bandwidth, derived, "Hz"));
  }
  if (drives_close_loops) {
    for (const WheelModel& wheel : robot.wheels) {
      const JointModel& joint = robot.joints[wheel.joint];
      if (!(joint.effort_limit > 0)) problems.push_back(powerless_message(joint, robot));
    }
  } else {
    check_loops(parameters, described, robot, period, problems);
  }
  return problems;
}

}  // namespace robot_control
