#pragma once
/// The encoder of a leg's joint reports angles that its joint cannot have. The worst joint is named.
///
///   jump   |q − q₀| − kFaster V t > limit, each joint with its own persistence. q₀ is the last angle that was
///          possible, t s ago, V the velocity limit
///   stuck  |c − c₀| > limit, while the robot is on its feet. c is the angle that q can show: the command demanded it
///          kAnswer cycles ago. c₀ was this angle when q changed for the last time. A joint that is blocked looks the
///          same. The command of a robot that walks demands angles of feet in the air alone. Its limit is kOfSwing
///          larger. q has to stay for kStays, and for two cycles: a noisy gyro moves the command at once, and no joint
///
/// While c stays, a stuck encoder changes nothing: the joint is where it reports to be. An angle that is missing or not
/// finite is not evaluated.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "machine/legs/leg_model.h"
#include "safety/conditions/common/condition_watch.h"
#include "safety/conditions/legged/commanded_foot.h"
#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"
#include "safety/safety_parameters.h"
#include "signals/fixed_vector.h"

namespace robot_control {

class EncoderConditions {
 public:
  static constexpr double kFaster = 1.1;     ///< as the default limit of joint_speed
  static constexpr double kOfSwing = 1.8;    ///< a foot leaves the ground late (docs/evidence/derivations.md)
  static constexpr double kStays = 0.01;     ///< s
  static constexpr std::size_t kAnswer = 2;  ///< cycles: command k − 1 moves the joint from cycle k to k + 1

  /// `period` s.
  EncoderConditions(const SafetyParameters& parameters, const LegModel& robot, double period) noexcept
      : stays_(std::max<std::uint64_t>(2, static_cast<std::uint64_t>(std::lround(kStays / period)))),
        jump_(kLegsJoints, {kCauseEncoderJump, parameters.encoder_jump, period}),
        stuck_(kCauseEncoderStuck, parameters.encoder_stuck, period) {
    for (std::size_t i = 0; i < kLegsJoints; ++i) joints_[i].reach = kFaster * robot.joints[i].velocity_limit * period;
  }

  void enter_run() noexcept {
    for (ConditionWatch& watch : jump_) watch.reset();
    stuck_.reset();
    for (Joint& joint : joints_) {
      joint.known = joint.demanded = false;
      joint.demand_count = 0;
    }
  }

  void step(const MonitorInput& input, std::uint64_t elapsed, ActiveCauses& out) noexcept {
    ConditionMeasurement stuck = kNothingMeasured;
    const bool walks = input.command != nullptr && input.command->legged.phase == LegPhase::kWalking;
    const double limit = (walks ? kOfSwing : 1) * stuck_.limit();
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      Joint& joint = joints_[i];
      joint.cycles += elapsed;
      const JointSample& sample = input.sensors->joints[i];
      ConditionMeasurement jump = kNothingMeasured;
      if (has_position(sample)) jump = beyond(i, jumped(joint, sample.position, jump_[i].limit()), jump_[i].limit());
      out.update(jump_[i], jump, elapsed);
      if (!has_position(sample)) continue;
      stuck = worse(stuck, beyond(i, demanded(joint, sample.position, demand(input.command, i), elapsed), limit));
    }
    out.update(stuck_, stuck, elapsed);
  }

 private:
  struct Joint {
    double reach = 0;                       ///< rad, in a cycle
    bool known = false;                     ///< q₀ is known
    double possible = 0;                    ///< rad, q₀
    std::uint64_t cycles = 0;               ///< since q₀
    std::array<double, kAnswer> demands{};  ///< rad, of the last commands, the oldest first
    std::size_t demand_count = 0;           ///< of `demands`
    bool demanded = false;                  ///< c₀ is known
    double reported = 0;                    ///< rad, the last q
    std::uint64_t stays = 0;                ///< cycles since it changed
    double demand = 0;                      ///< rad, c₀
  };

  /// Returns the command of a joint that demands an angle while the robot is on its feet; else null.
  static const JointCommand* demand(const CommandFrame* command, std::size_t joint) noexcept {
    if (command == nullptr || command->joints[joint].mode != JointMode::kImpedance) return nullptr;
    const LegPhase phase = command->legged.phase;
    const bool on_feet = phase == LegPhase::kRising || phase == LegPhase::kStanding || phase == LegPhase::kLowering ||
                         commanded_to_swing(command, joint);
    return on_feet ? &command->joints[joint] : nullptr;
  }

  /// Returns by how many rad the angle is beyond the reach of the joint.
  static double jumped(Joint& joint, double position, double limit) noexcept {
    const double past =
        joint.known ? std::abs(position - joint.possible) - joint.reach * static_cast<double>(joint.cycles) : 0;
    if (!joint.known || past <= limit) {
      joint.known = true;
      joint.possible = position;
      joint.cycles = 0;
    }
    return past;
  }

  /// Returns by how many rad the command moved while the angle stayed.
  double demanded(Joint& joint, double position, const JointCommand* command, std::uint64_t elapsed) const noexcept {
    double moved = 0;
    joint.stays = position == joint.reported ? joint.stays + elapsed : 0;
    if (joint.demand_count == kAnswer && command != nullptr) {
      if (!joint.demanded || position != joint.reported) joint.demand = joint.demands.front();
      joint.demanded = true;
      if (joint.stays >= stays_) moved = std::abs(joint.demands.front() - joint.demand);
    }
    joint.reported = position;
    remember(joint, command);
    return moved;
  }

  static void remember(Joint& joint, const JointCommand* command) noexcept {
    if (command == nullptr) {
      joint.demanded = false;
      joint.demand_count = 0;
      return;
    }
    std::rotate(joint.demands.begin(), joint.demands.begin() + 1, joint.demands.end());
    joint.demands.back() = command->position;
    joint.demand_count = std::min(joint.demand_count + 1, kAnswer);
  }

  std::uint64_t stays_;  ///< cycles
  std::array<Joint, kLegsJoints> joints_{};
  FixedVector<ConditionWatch, kLegsJoints> jump_;
  ConditionWatch stuck_;
};

}  // namespace robot_control
