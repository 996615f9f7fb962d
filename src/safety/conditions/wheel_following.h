#pragma once
/// Each wheel against what it was told.
///
/// With s the sign of the target q̇*, ω the measured speed (wheel_motion.h), δ its tolerance, both in the joint's sign;
/// only where a target reaches the wheel (wheel_targets.h):
///
///   stall            the angle ∫max(|q̇*|, w)dt that the wheel should have turned since it was last seen to turn,
///                    that is, with |ω| ≥ kTurns·|q̇*|, or to gain kProgress + δ towards its target; limit rad + 1
///                    quantum: a wheel that follows slowly shows a count each quantum. w = kPushed where the motor
///                    gives more than kPushedPart of its effort limit, else 0: a loop whose encoder is stuck pushes
///                    harder and harder, however slow its target. A target beyond the wheel's velocity limit
///                    counts as that limit
///   runaway          s·ω − |q̇*| > limit + δ;  |ω| where the target is 0
///   wrong_direction  −s·ω > limit + δ
///
/// The last two only while the wheel does not slow down: one that lost kProgress + δ of that speed since its
/// persistence began begins it anew. A drive at the limit of its torque, or a skid steer that scrubs, lags behind a
/// target that turns round; a wheel that runs away gets faster, or stays. Beyond kFarBeyond times the limit this is no
/// excuse: so far no drive lags, but a command that jumped, or an encoder that counts backwards, is there at once.
///
///   not_stopping     s of motion (standstill.h) since the robot was told to stand, until it stood for kRest: who
///                    rolls on, who is pushed, and who swings about his rest, standing at the turning points.
///                    Where no speed is known, nobody is said to move

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "robot/robot_model.h"
#include "safety/latch/active_causes.h"
#include "safety/measurements/joint_standstill.h"
#include "safety/measurements/wheel_motion.h"
#include "safety/measurements/wheel_targets.h"

namespace robot_control {

class WheelFollowing {
 public:
  static constexpr double kTurns = 0.2;
  static constexpr double kFarBeyond = 1.5;
  static constexpr double kProgress = 0.1;    ///< rad/s
  static constexpr double kRest = 0.5;        ///< s
  static constexpr double kPushed = 2.0;      ///< rad/s
  static constexpr double kPushedPart = 0.5;  ///< driving over bumps takes as much for 0.06 s, skid steers for 0.3 s

  /// `period` s.
  WheelFollowing(const SafetyParameters& parameters, const RobotModel& robot, double period);

  void enter_run() noexcept;
  void step(const SensorFrame& sensors, const WheelTargets& targets, const WheelMotion& motion,
            const JointStandstill& standstill, std::uint64_t elapsed, ActiveCauses& out) noexcept;

 private:
  /// Of one wheel.
  struct Stall {
    double missed = 0;  ///< rad
    double mark = 0;    ///< rad/s towards the target, when `missed` began
  };

  /// A speed that is beyond its limit, of one wheel, as long as the wheel does not lose it.
  struct Excess {
    ConditionWatch watch;
    double mark = 0;  ///< rad/s, since its persistence began; 0: not beyond

    void reset() noexcept;
    /// `speed` rad/s in the direction that is judged, `progress` what begins the persistence anew.
    void step(Finding finding, double speed, double progress, std::uint64_t elapsed, ActiveCauses& out) noexcept;
  };

  void judge_runaway(const WheelTargets& targets, const WheelMotion& motion, std::size_t wheel, std::uint64_t elapsed,
                     ActiveCauses& out) noexcept;
  void judge_direction(const WheelTargets& targets, const WheelMotion& motion, std::size_t wheel, std::uint64_t elapsed,
                       ActiveCauses& out) noexcept;
  Finding stalled(const SensorFrame& sensors, const WheelTargets& targets, const WheelMotion& motion,
                  double dt) noexcept;
  Finding not_stopped(const WheelTargets& targets, const JointStandstill& standstill, std::uint64_t elapsed) noexcept;

  /// rad/s, each wheel's velocity limit; ∞: none known.
  static constexpr std::array<double, kMaxWheels> without_limit() noexcept {
    std::array<double, kMaxWheels> speeds{};
    speeds.fill(std::numeric_limits<double>::infinity());
    return speeds;
  }

  double period_;
  ConditionWatch stall_;
  ConditionWatch not_stopping_;
  std::vector<Excess> runaway_;          ///< by wheel
  std::vector<Excess> wrong_direction_;  ///< by wheel
  std::array<Stall, kMaxWheels> stalls_{};
  std::array<double, kMaxWheels> pushes_{};  ///< N·m, from which on a motor does
  std::array<double, kMaxWheels> fastest_ = without_limit();
  std::uint64_t moved_ = 0;   ///< cycles of motion since it was told to stand
  std::uint64_t rested_ = 0;  ///< cycles in a row
};

}  // namespace robot_control
