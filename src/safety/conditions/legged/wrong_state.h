#pragma once
/// The estimator's state is compared with the gyro.
///
///   wrong state  |ω − ω_g| > limit, with the state's turning rate ω of the cycle before and the gyro's ω_g of that cycle
///
/// They differ by the gyro's bias. A walk is balanced by the state, so that a robot whose state has the wrong sign tips
/// within 0.2 s. A state that is 10 ms old may differ as much. Without one of them nothing is compared.

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "safety/conditions/common/condition_watch.h"
#include "safety/latch/active_causes.h"
#include "safety/safety_parameters.h"
#include "signals/state_frame.h"

namespace robot_control {

class WrongState {
 public:
  /// `period` s.
  WrongState(const SafetyParameters& parameters, double period) noexcept
      : watch_(kCauseWrongState, parameters.wrong_state, period) {}

  void enter_run() noexcept {
    watch_.reset();
    before_.fill(std::numeric_limits<double>::quiet_NaN());
  }

  /// `state`: of the cycle before; null: missing. `rate`: of the gyro in this cycle, rad/s, base axes, NaN without a
  /// sample.
  void step(const StateFrame* state, const Eigen::Vector3d& rate, std::uint64_t elapsed, ActiveCauses& out) noexcept {
    ConditionMeasurement measured = kNothingMeasured;
    if (state != nullptr && elapsed == 1) {
      const Eigen::Map<const Eigen::Vector3d> by_state(state->base.twist_base.angular.data()), by_gyro(before_.data());
      measured = beyond(kMaxJoints, (by_state - by_gyro).norm(), watch_.limit());
    }
    Eigen::Map<Eigen::Vector3d>(before_.data()) = rate;
    out.update(watch_, measured, elapsed);
  }

 private:
  ConditionWatch watch_;
  Vector3 before_{};  ///< rad/s, ω_g
};

}  // namespace robot_control
