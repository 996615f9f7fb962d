#pragma once
/// The joints of a robot on legs are compared with their own limits. Each joint has its own persistence. The first one
/// that was beyond its limit for so long is named.
///
///   joint speed   |q̇| / velocity limit > limit
///   joint effort  |τ| / effort limit > limit, for the persistence: no motor may do that for long
///   following     |q − its command| > limit, while the robot stands: an encoder or a drive that no longer moves.
///                 While it stands up, lies down or swings the leg, kFarTimes the limit counts. From there on n times
///                 the limit counts n cycles: full torque throws a robot over within 0.1 s.
///                 While it walks, the joints of feet in the air are judged: their mean over kMeanTime > kOfSwing limit.
///                 This mean stays while the foot bears.
///                 A motor of a robot that walks whose torque is wrong (motor_torque.h) in more than kOfTorques of the last
///                 cycles counts as an angle beyond the limit. Cycles are not judged in which the driver brakes, or
///                 the gate clamps a command by more than the effort limit
///                 An angle that moves against its command by more than kAgainst within a swing, less what it moves
///                 with it, counts as one beyond the limit: an encoder that counts backwards, or a motor with reversed
///                 wires. Both are compared over kStride cycles: a noisy gyro moves the command in each
///   joint range   distance beyond the nearer end stop > limit: the zero of an encoder, or a stop that broke
///
/// A number that is missing or not finite is not evaluated.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "machine/legs/leg_model.h"
#include "safety/conditions/common/condition_watch.h"
#include "safety/conditions/legged/commanded_foot.h"
#include "safety/conditions/legged/motor_torque.h"
#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"
#include "safety/safety_parameters.h"
#include "signals/fixed_vector.h"

namespace robot_control {

class JointConditions {
 public:
  static constexpr double kMeanTime = 0.2;   ///< s
  static constexpr double kOfSwing = 0.45;   ///< docs/evidence/derivations.md
  static constexpr double kOfTorques = 0.2;  ///< docs/evidence/derivations.md
  static constexpr double kAgainst = 0.2;    ///< rad (docs/evidence/derivations.md)
  static constexpr double kStride = 0.01;    ///< s

  /// `period` s.
  JointConditions(const SafetyParameters& parameters, const LegModel& robot, double period) noexcept
      : period_(period),
        speed_(kLegsJoints, {kCauseJointSpeed, parameters.joint_speed, period}),
        effort_(kLegsJoints, {kCauseJointEffort, parameters.joint_effort, period}),
        range_(kLegsJoints, {kCauseJointRange, parameters.joint_range, period}),
        following_(kLegsJoints, {kCauseJointFollowing, parameters.joint_following, period}),
        at_once_(kCauseJointFollowing, without_persistence(parameters.joint_following), period) {
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const JointModel& joint = robot.joints[i];
      limits_[i] = {.speed = joint.velocity_limit,
                    .effort = joint.effort_limit,
                    .range = joint.range.value_or(JointRange{-kInfinity, kInfinity})};
    }
  }

  void enter_run() noexcept {
    for (Watches* watches : {&speed_, &effort_, &range_, &following_})
      for (ConditionWatch& watch : *watches) watch.reset();
    at_once_.reset();
    behind_ = {};
    torques_ = {};
    ways_ = {};
  }

  void step(const MonitorInput& input, std::uint64_t elapsed, ActiveCauses& out) noexcept {
    const SensorFrame& sensors = *input.sensors;
    const LegPhase phase = input.command != nullptr ? input.command->legged.phase : LegPhase::kLying;
    if (phase != LegPhase::kWalking) {
      behind_ = {}, ways_ = {};
      for (MotorTorque& torque : torques_) torque.reset();
    }
    ConditionMeasurement at_once = kNothingMeasured;
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const JointSample& joint = sensors.joints[i];
      const Limits& limits = limits_[i];
      ConditionMeasurement effort = kNothingMeasured, range = kNothingMeasured, following = kNothingMeasured;
      if (has(joint, kValidEffort)) effort = beyond(i, std::abs(joint.effort) / limits.effort, effort_[i].limit());
      if (has_position(joint)) {
        const double outside = std::max(limits.range.lower - joint.position, joint.position - limits.range.upper);
        range = beyond(i, outside, range_[i].limit());
        following = follows(i, phase, input.command, joint.position, elapsed);
        at_once = worse(at_once, opposes(i, input.command, joint.position, elapsed));
      }
      at_once = worse(at_once, gives(i, input, elapsed));
      out.update(following_[i], following, weighed(following, elapsed));
      out.update(speed_[i], beyond(i, std::abs(valid_velocity(joint)) / limits.speed, speed_[i].limit()), elapsed);
      out.update(effort_[i], effort, elapsed);
      out.update(range_[i], range, elapsed);
    }
    out.update(at_once_, at_once, elapsed);
  }

 private:
  using Watches = FixedVector<ConditionWatch, kLegsJoints>;  ///< by joint

  ConditionMeasurement follows(std::size_t i, LegPhase phase, const CommandFrame* command, double position,
                               std::uint64_t elapsed) noexcept {
    const bool walks = phase == LegPhase::kWalking;
    if (phase == LegPhase::kLying || phase == LegPhase::kJoints) return kNothingMeasured;
    const JointCommand& joint = command->joints[i];
    const bool judged = walks ? commanded_to_swing(command, i) : joint.mode == JointMode::kImpedance;
    const double left = judged ? std::abs(joint.position - position) : 0;
    const double part = std::min(1.0, static_cast<double>(elapsed) * period_ / kMeanTime);
    if (walks && judged) behind_[i] += part * (left - behind_[i]);
    const double limit = at_once_.limit();
    if (left > (phase == LegPhase::kStanding ? 1 : kFarTimes) * limit) return beyond(i, left, limit);
    return walks ? beyond(i, behind_[i], kOfSwing * limit) : kNothingMeasured;
  }

  /// Returns how far the angle of a joint has moved against its command in this swing, as an angle beyond the limit.
  ConditionMeasurement opposes(std::size_t i, const CommandFrame* command, double position,
                               std::uint64_t elapsed) noexcept {
    Way& way = ways_[i];
    if (!commanded_to_swing(command, i)) {
      way = {};
      return kNothingMeasured;
    }
    const double asked = command->joints[i].position;
    if (!way.last) {
      way.last = {asked, position, 0};
    } else if (static_cast<double>(way.last->age += elapsed) * period_ > kStride - period_ / 2) {
      const double turned = position - way.last->angle, wanted = asked - way.last->asked;
      way.against = std::max(0.0, way.against + (wanted < 0 ? turned : wanted > 0 ? -turned : 0));
      way.last = {asked, position, 0};
    }
    return beyond(i, way.against / kAgainst * at_once_.limit(), at_once_.limit());
  }

  /// Returns how often the torque of a motor is wrong, as an angle.
  ConditionMeasurement gives(std::size_t i, const MonitorInput& input, std::uint64_t elapsed) noexcept {
    constexpr std::uint64_t kOtherLaw = kGateRateClamped | kGateSpeedClamped | kGatePositionClamped;
    MotorTorque& torque = torques_[i];
    const JointSample& joint = input.sensors->joints[i];
    const GateReport& gate = input.sensors->gate;
    if (!walks_by(input.command, i) || gate.verdict == GateVerdict::kBrake || elapsed > 1 ||
        (gate.reasons & kOtherLaw) != 0 || !finite(input.command->joints[i]) || !has(joint, kValidMotion) ||
        !std::isfinite(joint.position + joint.velocity + joint.effort)) {
      torque.forget();
      return kNothingMeasured;
    }
    torque.step(joint, input.command->joints[i], limits_[i].effort, period_);
    return beyond(i, torque.wrong() / kOfTorques * at_once_.limit(), at_once_.limit());
  }

  static Condition without_persistence(Condition condition) noexcept {
    condition.persistence = 0;
    return condition;
  }

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  struct Limits {
    double speed;      ///< rad/s
    double effort;     ///< N·m
    JointRange range;  ///< rad; ±∞ without end stops
  };

  /// How a joint and its command move while its foot is in the air.
  struct Way {
    struct Angles {
      double asked, angle;  ///< rad
      std::uint64_t age;    ///< cycles
    };
    std::optional<Angles> last;
    double against = 0;  ///< rad, ≥ 0, in this swing
  };

  double period_;
  std::array<Limits, kLegsJoints> limits_{};
  LegsValues behind_{};  ///< rad, of joints of feet in the air, the mean
  std::array<MotorTorque, kLegsJoints> torques_{};
  std::array<Way, kLegsJoints> ways_{};
  Watches speed_, effort_, range_, following_;
  ConditionWatch at_once_;
};

}  // namespace robot_control
