#pragma once
/// These conditions find wheels that do not follow their targets.
///
/// s: sign of the target q̇*; ω: measured speed (wheel_motion.h); δ: its tolerance; all in the joint's sign. Evaluated
/// only while a target reaches the wheel (wheel_targets.h).
///
///   stall            the angle ∫max(|q̇*|, w, u)dt that the wheel should have turned since it last turned. It turns
///                    while |ω| ≥ kTurns·|q̇*|, or where it gained kProgress + δ towards its target. Limit: rad + 1
///                    quantum, because a slowly turning wheel shows a count per quantum. w = kPushed while the motor
///                    torque τ, and τ less that of the planned acceleration (planned_torque.h), are above `pushed`,
///                    else 0: a loop with a stuck encoder increases its torque however slow the target is. Not before
///                    the target itself has moved by a quantum, though: until then a wheel that turns need not have
///                    shown a count, and inside a curve of a skid steer it takes most of its torque. A target above the
///                    wheel's velocity limit counts as that limit. In a turn nothing counts while s·τ ≤ `held` and
///                    still grows, by kRise of it within kBuildUp: the loop is about to overcome the friction of treads
///                    that scrub, for instance after a reversal. So kExcused of the limit is excused at most.
///                      pushed = max(kPushedPart·τ_max, min(kLargePart·τ_max, kFrictions·(f + S)))
///                      held   = min(pushed, f + kGrounds·S*)
///                    τ_max, f: effort limit and dry friction of the joint; S*: torque of scrub.h at the targets, at
///                    ground friction 1, S: its largest. 0 for one wheel a side: then `held` is −∞
///   runaway          s·ω − |q̇*| > limit + δ;  |ω| if the target is 0
///   wrong_direction  −s·ω > limit + δ
/// Without a measured torque `stall` counts w = 0 and excuses nothing: a wheel that stands is found by its target
/// alone, and a stuck encoder under a target below kPushed later. A runaway of 3 × limit and more has a shorter
/// persistence (condition_watch.h).
///
/// The persistence of the last two restarts whenever the wheel has lost kProgress + δ of that speed since it began. A
/// drive at its torque limit, or a scrubbing skid steer, lags behind a target that changes sign, but slows down. A
/// wheel that runs away does not. Beyond kFarBeyond times the limit the persistence is not restarted. No lag is that
/// large, but a command that jumped, or an encoder that counts backwards, exceeds it at once.
///
///   not_stopping     s of motion (joint_standstill.h) since standstill was commanded, until the robot stood for kRest.
///                    Covers robots that roll on, are pushed, or oscillate about their rest position and stand at the
///                    turning points. Without a known wheel speed the condition is not evaluated

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "machine/wheeled/drive_train.h"
#include "machine/wheeled/scrub.h"
#include "safety/latch/active_causes.h"
#include "safety/measurements/joint_standstill.h"
#include "safety/measurements/planned_torque.h"
#include "safety/measurements/wheel_motion.h"
#include "safety/measurements/wheel_targets.h"
#include "signals/fixed_vector.h"

namespace robot_control {

class WheelFollowing {
 public:
  static constexpr double kTurns = 0.2;
  static constexpr double kFarBeyond = 1.5;
  static constexpr double kProgress = 0.1;    ///< rad/s
  static constexpr double kRest = 0.5;        ///< s
  static constexpr double kPushed = 2.0;      ///< rad/s
  static constexpr double kPushedPart = 0.5;  ///< docs/evidence/derivations.md
  static constexpr double kLargePart = 0.9;
  static constexpr double kFrictions = 1.2;
  static constexpr double kGrounds = 3.0;  ///< times friction 1: the best grip
  static constexpr double kRise = 0.01;
  static constexpr double kBuildUp = 0.03;  ///< s
  static constexpr double kExcused = 0.5;

  /// `period` s.
  WheelFollowing(const SafetyParameters& parameters, const DriveTrain& robot, double period);

  void enter_run() noexcept;
  /// `yaw_excess` rad/s, x.
  void step(const SensorFrame& sensors, const WheelTargets& targets, const WheelMotion& motion,
            const JointStandstill& standstill, double yaw_excess, std::uint64_t elapsed, ActiveCauses& out) noexcept;

 private:
  /// The stall measurement of one wheel.
  struct Stall {
    double missed = 0;                                       ///< rad
    double target_travel = 0;                                ///< rad, ∫|q̇*|dt since the wheel last turned
    double excused = 0;                                      ///< rad, while the torque grew
    double mark = 0;                                         ///< rad/s towards the target, when `missed` began
    double peak = -std::numeric_limits<double>::infinity();  ///< N·m towards the target, since then
    double level = 0;                                        ///< s since the torque grew

    bool builds_up(double torque, double held, double dt) noexcept;
  };

  /// A speed of one wheel beyond its limit, as long as the wheel does not slow down.
  struct Excess {
    ConditionWatch watch;
    double mark = 0;  ///< rad/s, since its persistence began; 0: not beyond

    void reset() noexcept;
    /// `speed` rad/s in the evaluated direction; `progress` rad/s, a loss of speed that restarts the persistence.
    void step(const ConditionMeasurement& measurement, double speed, double progress, std::uint64_t elapsed,
              ActiveCauses& out) noexcept;
  };

  void update_excesses(const WheelTargets& targets, const WheelMotion& motion, std::size_t wheel, std::uint64_t elapsed,
                       ActiveCauses& out) noexcept;
  ConditionMeasurement stalled(const SensorFrame& sensors, const WheelTargets& targets, const WheelMotion& motion,
                               double yaw_excess, double dt) noexcept;
  double held(std::size_t wheel, double scrubbing) const noexcept;
  ConditionMeasurement not_stopped(const WheelTargets& targets, const JointStandstill& standstill,
                                   std::uint64_t elapsed) noexcept;

  /// rad/s, each wheel's velocity limit; ∞: none known.
  static constexpr std::array<double, kMaxWheels> without_limit() noexcept {
    std::array<double, kMaxWheels> speeds{};
    speeds.fill(std::numeric_limits<double>::infinity());
    return speeds;
  }

  double period_;
  ConditionWatch stall_;
  ConditionWatch not_stopping_;
  FixedVector<Excess, kMaxWheels> runaway_;          ///< by wheel
  FixedVector<Excess, kMaxWheels> wrong_direction_;  ///< by wheel
  std::array<Stall, kMaxWheels> stalls_{};
  std::array<double, kMaxWheels> pushed_{};    ///< N·m
  std::array<double, kMaxWheels> friction_{};  ///< N·m, f
  std::array<double, kMaxWheels> per_yaw_{};   ///< b/radius
  PlannedTorque planned_;
  Scrub scrub_;
  bool scrubs_;
  std::array<double, kMaxWheels> fastest_ = without_limit();
  std::uint64_t moved_ = 0;   ///< cycles of motion since standstill was commanded
  std::uint64_t rested_ = 0;  ///< cycles of rest in a row
};

}  // namespace robot_control
