#pragma once
/// These conditions find wheels that are faster than their targets. With s the sign of the target q̇*, ω the measured
/// speed (wheel_motion.h) and δ its tolerance, all in the joint's sign:
///
///   runaway          s·ω − |q̇*| > limit + δ;  |ω| if the target is 0
///   wrong_direction  −s·ω > limit + δ
///
/// They are evaluated only while a target reaches the wheel (wheel_targets.h). A runaway of kFarTimes the limit and
/// more has a shorter persistence (condition_watch.h).
///
/// The persistence restarts whenever the wheel has lost kMinProgress + δ of that speed since it began. A drive at its
/// torque limit, or a scrubbing skid steer, lags behind a target that changes sign, but slows down. A wheel that runs
/// away does not. Beyond kFarBeyond times the limit the persistence is not restarted. No lag is that large, but a
/// command that jumped, or an encoder that counts backwards, exceeds it at once.

#include <cmath>
#include <cstddef>

#include "safety/conditions/common/condition_list.h"
#include "safety/conditions/wheeled/wheeled_observer.h"

namespace robot_control {

template <StopCause kCause>
class WheelExcess {
 public:
  static constexpr double kFarBeyond = 1.5;
  static constexpr double kMinProgress = 0.1;  ///< rad/s

  WheelExcess(const SafetyParameters& parameters, const DriveTrain& robot, double period)
      : wheels_(robot.wheels.size(), {.watch = ConditionWatch(kCause, condition_of<kCause>(parameters), period)}) {}

  void enter_run() noexcept {
    for (Wheel& wheel : wheels_) wheel.reset();
  }

  void step(const WheeledMeasurements& now, ActiveCauses& out) noexcept {
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      Wheel& wheel = wheels_[i];
      const double speed = excess_speed(now.targets[i], now.motion.speed(i)), tolerance = now.motion.speed_tolerance(i);
      const double above = kCause == kCauseRunaway ? speed - std::abs(now.targets[i]) : speed;
      const ConditionMeasurement measurement = beyond(i, above, wheel.watch.limit() + tolerance);
      if (!now.motion.speed_known() || !now.targets.has(i) || !measurement.beyond) {
        wheel.reset();
        continue;
      }
      const bool slows = wheel.mark != 0 && speed < wheel.mark - (kMinProgress + tolerance) &&
                         measurement.value <= kFarBeyond * measurement.limit;
      if (wheel.mark == 0 || slows) wheel.mark = speed;
      if (slows) {
        wheel.watch.reset();
      } else {
        out.update(wheel.watch, kCause == kCauseRunaway ? weighed(measurement) : measurement, now.elapsed);
      }
    }
  }

 private:
  struct Wheel {
    ConditionWatch watch;
    double mark = 0;  ///< rad/s, `excess_speed` when its persistence began; 0: not beyond

    void reset() noexcept {
      watch.reset();
      mark = 0;
    }
  };

  /// rad/s, towards the target for a runaway, else against it.
  static double excess_speed(double target, double speed) noexcept {
    const double towards = target == 0 ? std::abs(speed) : target < 0 ? -speed : speed;
    if (kCause == kCauseRunaway) return towards;
    return target == 0 ? 0 : -towards;
  }

  FixedVector<Wheel, kMaxWheels> wheels_;  ///< by wheel
};

}  // namespace robot_control
