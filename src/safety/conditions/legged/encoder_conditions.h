#pragma once
/// The encoder of a leg's joint reports angles that its joint cannot have. The worst joint is named.
///
///   jump   |q − q₀| − kFaster V t > limit, each joint with its own persistence. q₀ is the last angle that was
///          possible, t s ago, V the velocity limit
///   stuck  |c − c₀| > limit, while the robot is on its feet. c is the angle that q can show: the command demanded it
///          kAnswer cycles ago. c₀ was this angle when q changed for the last time. A joint that is blocked looks the
///          same. The command of a robot that walks demands angles of feet in the air alone. The limit is kLateFactor
///          larger for these, and while the robot rises: a load holds its joints at first. q has to stay within kSame
///          for kRepeatTime and kFewest new samples, because a noisy gyro moves the command at once. What the last new
///          sample showed holds until the next one
///
/// Only a new sample shows that q stays, or that it was possible: a drive that sent nothing repeats its last one.
///
/// While c stays, a stuck encoder changes nothing: the joint is where it reports to be. An angle that is missing or not
/// finite is not evaluated.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "safety/conditions/common/condition_list.h"
#include "safety/conditions/legged/legged_observer.h"

namespace robot_control {

class EncoderJump {
 public:
  static constexpr double kFaster = 1.1;  ///< as the default limit of joint_speed

  /// `period` s.
  EncoderJump(const SafetyParameters&, const LegModel&, double period) noexcept : period_(period) {}
  void enter_run() noexcept { joints_ = {}; }

  ConditionMeasurement measure(const LeggedMeasurements& now, const ConditionWatch& watch, std::size_t i) noexcept {
    Joint& joint = joints_[i];
    joint.cycles += now.elapsed;
    if (!has_position(now.joint(i))) return kNothingMeasured;
    const double position = now.joint(i).position, reach = kFaster * now.limits[i].speed * period_;
    const double past =
        joint.known ? std::abs(position - joint.possible) - reach * static_cast<double>(joint.cycles) : 0;
    if (past <= watch.limit() && now.new_samples[i]) joint = {.known = true, .possible = position};
    return beyond(i, past, watch.limit());
  }

 private:
  struct Joint {
    bool known = false;        ///< q₀ is known
    double possible = 0;       ///< rad, q₀
    std::uint64_t cycles = 0;  ///< since q₀
  };

  double period_;
  std::array<Joint, kLegsJoints> joints_{};
};

class EncoderStuck {
 public:
  static constexpr double kLateFactor = 1.8;   ///< what leaves the ground is late (docs/evidence/derivations.md)
  static constexpr double kRepeatTime = 0.01;  ///< s
  static constexpr double kSame = 2.5e-5;      ///< rad: half a code of velocity of an AK of 51 rad/s, times 2 ms
  static constexpr std::uint64_t kFewest = 2;  ///< new samples
  static constexpr std::size_t kAnswer = 2;    ///< cycles: command k − 1 moves the joint from cycle k to k + 1

  /// `period` s.
  EncoderStuck(const SafetyParameters&, const LegModel&, double period) noexcept
      : stays_(static_cast<std::uint64_t>(std::lround(kRepeatTime / period))) {}
  void enter_run() noexcept { joints_ = {}; }

  ConditionMeasurement measure(const LeggedMeasurements& now, const ConditionWatch& watch) noexcept {
    const bool late = now.walks() || now.phase == LegPhase::kRising;
    const double limit = (late ? kLateFactor : 1) * watch.limit();
    return worst_of(kLegsJoints, [&](std::size_t i) {
      return has_position(now.joint(i)) ? beyond(i, command_moved(now, i), limit) : kNothingMeasured;
    });
  }

 private:
  struct Joint {
    std::array<double, kAnswer> demands{};  ///< rad, of the last commands, the oldest first
    std::size_t demand_count = 0;           ///< of `demands`
    bool demanded = false;                  ///< c₀ is known
    double reported = 0;                    ///< rad, q where it changed last
    std::uint64_t cycles = 0;               ///< since the last new sample
    std::uint64_t stays = 0;                ///< cycles since q changed, up to the last new sample
    std::uint64_t samples = 0;              ///< new ones since then
    double demand = 0;                      ///< rad, c₀
    double moved = 0;                       ///< rad, |c − c₀| at the last new sample
  };

  /// The command demands an angle of this joint while the robot is on its feet.
  static bool demands(const LeggedMeasurements& now, std::size_t i) noexcept {
    if (now.walks()) return now.swings(i);
    const bool on_feet =
        now.phase == LegPhase::kRising || now.phase == LegPhase::kStanding || now.phase == LegPhase::kLowering;
    return on_feet && now.command(i).mode == JointMode::kImpedance;
  }

  /// Returns by how many rad the command moved while the angle stayed.
  double command_moved(const LeggedMeasurements& now, std::size_t i) noexcept {
    Joint& joint = joints_[i];
    const double position = now.joint(i).position;
    const bool changed = now.new_samples[i] && !(std::abs(position - joint.reported) <= kSame);
    const bool commanded = demands(now, i), judged = joint.demand_count == kAnswer && commanded;
    joint.cycles += now.elapsed;
    if (now.new_samples[i]) {
      joint.stays = changed ? 0 : joint.stays + joint.cycles;
      joint.samples = changed ? 0 : joint.samples + 1;
      joint.cycles = 0;
    }
    if (changed) joint.reported = position;
    if (judged && (!joint.demanded || changed)) joint.demand = joint.demands.front();
    joint.demanded = joint.demanded || judged;
    const bool stuck = judged && joint.stays >= stays_ && joint.samples >= kFewest;
    if (now.new_samples[i] || !stuck) joint.moved = stuck ? std::abs(joint.demands.front() - joint.demand) : 0;
    joint.demanded = joint.demanded && commanded;
    joint.demand_count = commanded ? std::min(joint.demand_count + 1, kAnswer) : 0;
    std::rotate(joint.demands.begin(), joint.demands.begin() + 1, joint.demands.end());
    if (commanded) joint.demands.back() = now.command(i).position;
    return joint.moved;
  }

  std::uint64_t stays_;  ///< cycles
  std::array<Joint, kLegsJoints> joints_{};
};

using EncoderConditions = ConditionList<WatchedCondition<kCauseEncoderJump, EncoderJump, kLegsJoints>,
                                        WatchedCondition<kCauseEncoderStuck, EncoderStuck>>;

}  // namespace robot_control
