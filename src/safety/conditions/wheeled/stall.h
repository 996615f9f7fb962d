#pragma once
/// This condition finds a wheel that does not turn as its target demands.
///
///   stall    ∫ max(|q̇*|, w, u) dt since the wheel last turned > limit + 1 quantum, in rad
///
/// q̇*  the target, at most the wheel's velocity limit, while it reaches the wheel (wheel_targets.h). The wheel turns
///     while its speed is at least kTurns·|q̇*|, or when it gained kMinProgress + tolerance towards its target
/// w   kPushedSpeed while the motor torque, and that torque less the planned one (planned_torque.h), are above
/// `pushed`,
///     else 0. It counts after the target itself has moved by a quantum
/// u   the rotation of a wheel by which gyro and wheels disagree beyond the limit of yaw_rate
///
/// In a turn of treads that scrub, nothing counts while the torque is at most `held` and still grows by kTorqueRise of
/// it within kBuildUp. At most kMaxExcusedShare of the limit is excused.
///
///   pushed = max(kPushedPart·τ_max, min(kLargePart·τ_max, kFrictions·(f + S)))
///   held   = min(pushed, f + kGrounds·S*)
///
/// τ_max, f: effort limit and dry friction of the joint; S*: torque of scrub.h at the targets, at ground friction 1; S:
/// its largest. With one wheel a side nothing is excused. Without a measured torque w is 0. The reasons:
/// docs/evidence/derivations.md.

#include <array>
#include <cstddef>
#include <limits>

#include "machine/wheeled/scrub.h"
#include "safety/conditions/common/condition_list.h"
#include "safety/conditions/wheeled/wheeled_observer.h"
#include "safety/measurements/planned_torque.h"

namespace robot_control {

class Stall {
 public:
  static constexpr double kTurns = 0.2;
  static constexpr double kMinProgress = 0.1;  ///< rad/s
  static constexpr double kPushedSpeed = 2.0;  ///< rad/s
  static constexpr double kPushedPart = 0.5;   ///< docs/evidence/derivations.md
  static constexpr double kLargePart = 0.9;
  static constexpr double kFrictions = 1.2;
  static constexpr double kGrounds = 3.0;  ///< times friction 1: the best grip
  static constexpr double kTorqueRise = 0.01;
  static constexpr double kBuildUp = 0.03;  ///< s
  static constexpr double kMaxExcusedShare = 0.5;

  Stall(const SafetyParameters& parameters, const DriveTrain& robot, double period);

  void enter_run() noexcept;
  ConditionMeasurement measure(const WheeledMeasurements& now, const ConditionWatch& watch) noexcept;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  struct Wheel {
    double pushed = 0;           ///< N·m
    double friction = 0;         ///< N·m, f
    double per_yaw = 0;          ///< b/radius
    double fastest = kInfinity;  ///< rad/s, velocity limit
  };

  /// The sums since the wheel last turned.
  struct Standing {
    double missed = 0;         ///< rad
    double target_travel = 0;  ///< rad, ∫|q̇*|dt
    double excused = 0;        ///< rad, while the torque grew
    double mark = 0;           ///< rad/s towards the target, when it began
    double peak = -kInfinity;  ///< N·m towards the target
    double level = 0;          ///< s since the torque grew

    bool builds_up(double torque, double held, double dt) noexcept;
  };

  double held(std::size_t wheel, double scrubbing) const noexcept;

  std::array<Wheel, kMaxWheels> wheels_{};
  std::array<Standing, kMaxWheels> standing_{};
  PlannedTorque planned_;
  Scrub scrub_;
  bool scrubs_;
};

}  // namespace robot_control
