#pragma once
/// The joints of a robot on legs are compared with their own limits. Each joint has its own persistence. The first one
/// that was beyond its limit for so long is named.
///
///   joint speed   |q̇| / velocity limit > limit
///   joint effort  |τ| / effort limit > limit, for the persistence: no motor may do that for long
///   joint range   distance beyond the nearer end stop > limit: the zero of an encoder, or a stop that broke
///   following     |q − its command| > limit, while the robot stands. While it stands up, lies down or swings the leg,
///                 kFarTimes the limit counts
///                 while it walks: the mean over kMeanTime, of the joints of feet in the air, > limit
///                 while it walks, without a persistence: one of
///                   part of the last cycles in which the torque was wrong (motor_torque.h) > kWrongTorqueShare
///                   angle by which the joint moved against its command in this swing > kMaxOpposition
///
/// From kFarTimes the limit on, n times the limit counts n cycles: full torque throws a robot over within 0.1 s.
/// Torques are not judged in cycles in which the driver brakes, or the gate clamps a command by more than the effort
/// limit. A number that is missing or not finite is not evaluated. The reasons: docs/evidence/derivations.md.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "safety/conditions/common/condition_list.h"
#include "safety/conditions/legged/legged_observer.h"
#include "safety/conditions/legged/motor_torque.h"

namespace robot_control {

struct LegJointLaws {
  static ConditionMeasurement speed(const LeggedMeasurements& now, const ConditionWatch& watch,
                                    std::size_t i) noexcept {
    return beyond(i, std::abs(valid_velocity(now.joint(i))) / now.limits[i].speed, watch.limit());
  }

  static ConditionMeasurement effort(const LeggedMeasurements& now, const ConditionWatch& watch,
                                     std::size_t i) noexcept {
    if (!has(now.joint(i), kValidEffort)) return kNothingMeasured;
    return beyond(i, std::abs(now.joint(i).effort) / now.limits[i].effort, watch.limit());
  }

  static ConditionMeasurement range(const LeggedMeasurements& now, const ConditionWatch& watch,
                                    std::size_t i) noexcept {
    if (!has_position(now.joint(i))) return kNothingMeasured;
    const double position = now.joint(i).position;
    const JointRange& range = now.limits[i].range;
    return beyond(i, std::max(range.lower - position, position - range.upper), watch.limit());
  }
};

/// The angles between joints and commands.
class JointFollowing {
 public:
  static constexpr double kMeanTime = 0.2;  ///< s

  JointFollowing(const SafetyParameters&, const LegModel&, double) noexcept {}
  void enter_run() noexcept { behind_ = {}; }
  ConditionMeasurement measure(const LeggedMeasurements& now, const ConditionWatch& watch, std::size_t i) noexcept;

 private:
  std::array<double, kLegsJoints> behind_{};  ///< rad, of joints of feet in the air, the mean
};

/// Joints of a robot that walks whose motors or encoders do something else than their commands demand.
class JointMismatch {
 public:
  static constexpr double kWrongTorqueShare = 0.2;  ///< docs/evidence/derivations.md
  static constexpr double kMaxOpposition = 0.2;     ///< rad (docs/evidence/derivations.md)
  static constexpr double kStride = 0.01;           ///< s

  /// `period` s.
  JointMismatch(const SafetyParameters&, const LegModel&, double period) noexcept : period_(period) {}
  void enter_run() noexcept {
    torques_ = {};
    swings_ = {};
  }
  ConditionMeasurement measure(const LeggedMeasurements& now, const ConditionWatch& watch) noexcept;

 private:
  double moved_against_command(const LeggedMeasurements& now, std::size_t i) noexcept;
  double wrong_torque(const LeggedMeasurements& now, std::size_t i) noexcept;

  /// How a joint and its command move while its foot is in the air.
  struct Swing {
    struct Angles {
      double command, joint;  ///< rad
      std::uint64_t age;      ///< cycles
    };
    std::optional<Angles> last;
    double against = 0;  ///< rad, ≥ 0, in this swing
  };

  double period_;
  std::array<MotorTorque, kLegsJoints> torques_{};
  std::array<Swing, kLegsJoints> swings_{};
};

using JointConditions = ConditionList<WatchedCondition<kCauseJointFollowing, JointFollowing, kLegsJoints>,
                                      WatchedCondition<kCauseJointSpeed, Stateless<LegJointLaws::speed>, kLegsJoints>,
                                      WatchedCondition<kCauseJointEffort, Stateless<LegJointLaws::effort>, kLegsJoints>,
                                      WatchedCondition<kCauseJointRange, Stateless<LegJointLaws::range>, kLegsJoints>,
                                      WatchedCondition<kCauseJointFollowing, JointMismatch>>;

}  // namespace robot_control
