#pragma once
/// The user's parameters of the safety monitor.
///
/// A condition is active when a quantity measured from raw sensors and the command is beyond `limit` without
/// interruption for `persistence`. Only the condition wrong_state reads the estimate, to check it. An active condition
/// is a cause, and `reaction` is what the monitor does. The conditions and their defaults: signals/stop_causes.def.
/// They are defined in conditions/wheeled, conditions/legged and conditions/common.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "parameters/block.h"
#include "signals/joint.h"
#include "signals/permit.h"
#include "signals/wheeled/wheel_count.h"

namespace robot_control {

/// From mild to severe; the severest reaction of all active conditions wins.
enum class Reaction : std::uint8_t {
  kOff,    ///< the condition is not evaluated
  kWarn,   ///< reported
  kSlow,   ///< reported; rim speeds limited to slow_speed while the condition is active and for kWarningHold after it
  kRamp,   ///< latched, stop category 1 of IEC 60204-1: ramp under supervision, then brake
  kBrake,  ///< latched, stop category 0: brake at once
};

inline std::vector<Word> words_of(Reaction) {
  using enum Reaction;
  return {{"off", kOff}, {"warn", kWarn}, {"slow", kSlow}, {"ramp", kRamp}, {"brake", kBrake}};
}

struct Condition {
  std::optional<double> limit;  ///< absent: derived from the robot where it can be (derived_limits.h, on legs
                                ///< legged_conditions.h), else no condition
  double persistence = 0;       ///< s; 0: the first cycle counts
  Reaction reaction = Reaction::kBrake;
};

/// The persistence is at most a minute; a longer one would not stop the robot in time.
inline Keys keys(std::string_view name, Condition& condition) {
  return {{"persistence", &condition.persistence, "s", 0, 60, 0, {}, name},
          {"reaction", &condition.reaction, {}, 0, 0, 0, {}, name}};
}

struct SafetyParameters {
  std::uint64_t loss_cycles = 20;  ///< cycles without a command or a state after which the stop latches
  double heartbeat_timeout = 0;    ///< s; 0 = no operator heartbeat is required
  double start_timeout = 30;       ///< s for which the machine may be starting (DriverState::kStarting)
  double ramp_time = 2.0;          ///< s, longest category-1 ramp before the brake
  double standstill_speed = 0.05;  ///< rad/s, wheels slower than this are standing

  double slow_speed = 0.3;           ///< m/s, of the rims, under Reaction::kSlow
  double clearance = 0;              ///< m, free distance ahead until the first message on the topic; 0: unlimited
  std::optional<double> stop_delay;  ///< s, from the event to the brake torque; absent: default_stop_delay
  double stop_deceleration = 0.5;    ///< m/s², which braking and ramping reach on every ground the robot drives on

  // clang-format off
#define CAUSE(...)
#define CONDITION(id, name, sentence, remedy, actor, unit, min, max, limit, persistence, reaction, meaning) \
  Condition name{limit, persistence, Reaction::reaction};
#define CONDITION_WITHOUT_LIMIT(id, name, sentence, remedy, actor, unit, persistence, reaction, meaning) \
  Condition name{0, persistence, Reaction::reaction};  ///< limit unused
#include "signals/stop_causes.def"
  // clang-format on

  /// N·m/rad, of each wheel: RMS of the torque that the derived gains produce from encoder quantisation, divided by the
  /// size of a count. Not a user parameter: it follows from robot and rate (robots/wheeled/safety_limits.h).
  std::array<double, kMaxWheels> count_ripple{};

  /// JointValidity bits that a driven joint must report. Not a user parameter: velocity drives need not measure torque.
  std::uint32_t joint_numbers = kValidMotion;
};

// clang-format off
/// The condition of a cause of CONDITION or CONDITION_WITHOUT_LIMIT.
template <StopCause kWanted>
constexpr const Condition& condition_of(const SafetyParameters& parameters) noexcept {
#define CAUSE(...)
#define CONDITION(id, name, ...) if constexpr (kWanted == kCause##id) return parameters.name;
#define CONDITION_WITHOUT_LIMIT(id, name, ...) CONDITION(id, name)
#include "signals/stop_causes.def"
}
// clang-format on

/// s. A stop takes the sensors of one period, the permit of the next and the torque of the one after.
constexpr double fastest_stop(double period) noexcept {
  return 3 * period;
}

/// s, stop_delay where it is left out.
constexpr double default_stop_delay(double period) noexcept {
  constexpr double kStopDelay = 0.03;
  return std::max(kStopDelay, fastest_stop(period));
}

// clang-format off
inline Keys keys(SafetyParameters& safety) {
  return joined({
      {
        // The limit is above the four cycles for which the gate uses a command: a held command does not mean a lost node.
        {"loss_cycles", &safety.loss_cycles, "cycles", 5, 10000},
        {"heartbeat_timeout", &safety.heartbeat_timeout, "s", 0, 60, kLoopTimeout | kZeroIsOff},
        {"start_timeout", &safety.start_timeout, "s", 1, 3600},
        {"ramp_time", &safety.ramp_time, "s", 0.01, 60},
        // A reset must not release a moving robot.
        {"standstill_speed", &safety.standstill_speed, "rad/s", 1.0e-6, 0.5},
        {"slow_speed", &safety.slow_speed, "m/s", 0, 50},
        {"clearance", &safety.clearance, "m", 0, 10000, kZeroIsOff},
        {"stop_delay", &safety.stop_delay, "s", 0, 10, kOptional},
        {"stop_deceleration", &safety.stop_deceleration, "m/s²", 0.001, 100},
      },
#define CAUSE(...)
#define CONDITION(id, name, sentence, remedy, actor, unit, min, max, ...) \
      {{"limit", &safety.name.limit, unit, min, max, SafetyParameters{}.name.limit ? 0U : unsigned{kOptional}, {}, #name}}, \
      keys(#name, safety.name),
#define CONDITION_WITHOUT_LIMIT(id, name, ...) keys(#name, safety.name),
#include "signals/stop_causes.def"
  });
}
// clang-format on

/// Checks that an empty battery has a lower voltage than a low one. `block` is the name of the block that has these
/// keys.
inline void check(const SafetyParameters& safety, const std::string& block, GivenValues& given) {
  const std::string low = block + ".battery_low.limit";
  const std::string empty = block + ".battery_empty.limit";
  if (!given.accepted(low) || !given.accepted(empty) || *safety.battery_empty.limit < *safety.battery_low.limit) return;
  given.refuse(empty, "must be below " + given.shown(low));
}

}  // namespace robot_control
