#pragma once
/// The conditions of a robot on wheels: how its wheels and its body move, compared with limits and targets. Limits that
/// are left out are not evaluated: call derived_limits (derived_limits.h) first.

#include <cstdint>

#include "safety/conditions/common/body_conditions.h"
#include "safety/conditions/common/condition_list.h"
#include "safety/conditions/common/condition_set.h"
#include "safety/conditions/wheeled/stall.h"
#include "safety/conditions/wheeled/torque_oscillation.h"
#include "safety/conditions/wheeled/wheel_excess.h"
#include "safety/conditions/wheeled/wheel_limits.h"
#include "safety/conditions/wheeled/wheeled_observer.h"
#include "safety/monitor.h"

namespace robot_control {

/// This condition finds a robot that still moves although it is commanded to stand.
///
///   not_stopping     s of motion (joint_standstill.h) since standstill was commanded, until the robot stood for kRestTime.
///                    Covers robots that roll on, are pushed, or oscillate about their rest position and stand at the
///                    turning points. Without a known wheel speed the condition is not evaluated
class NotStopping {
 public:
  static constexpr double kRestTime = 0.5;  ///< s

  NotStopping(const SafetyParameters&, const DriveTrain&, double period) noexcept : period_(period) {}

  void enter_run() noexcept { moved_ = rested_ = 0; }

  ConditionMeasurement measure(const WheeledMeasurements& now, const ConditionWatch& watch) noexcept {
    if (!now.motion.speed_known()) return kNothingMeasured;
    const bool moves = now.standstill.moving();
    rested_ = moves ? 0 : rested_ + now.elapsed;
    if (!now.targets.commanded_to_stand() || static_cast<double>(rested_) * period_ >= kRestTime) {
      moved_ = 0;
    } else if (moves) {
      moved_ += now.elapsed;
    }
    return beyond(kMaxJoints, static_cast<double>(moved_) * period_, watch.limit());
  }

 private:
  double period_;
  std::uint64_t moved_ = 0;   ///< cycles of motion since standstill was commanded
  std::uint64_t rested_ = 0;  ///< cycles of rest in a row
};

using WheeledConditions = ConditionSet<WheeledObserver,                                   //
                                       WheelLimits,                                       //
                                       WheelExcess<kCauseRunaway>,                        //
                                       WheelExcess<kCauseWrongDirection>,                 //
                                       WatchedCondition<kCauseStall, Stall>,              //
                                       WatchedCondition<kCauseNotStopping, NotStopping>,  //
                                       TorqueOscillation,                                 //
                                       BodyConditions>;

/// The monitor of a robot on wheels.
using SafetyMonitor = Monitor<WheeledConditions>;

}  // namespace robot_control
