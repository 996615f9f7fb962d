#pragma once
/// The estimator's state is compared with the gyro.
///
///   wrong state  |ω − ω_g| > limit, with the state's turning rate ω of the cycle before and the gyro's ω_g of that cycle
///
/// They differ by the gyro's bias. A walk is balanced by the state, so that a robot whose state has the wrong sign tips
/// within 0.2 s. A state that is 10 ms old may differ as much. Without one of them nothing is compared.

#include <Eigen/Core>
#include <limits>

#include "machine/stored.h"
#include "safety/conditions/legged/legged_observer.h"

namespace robot_control {

class WrongState {
 public:
  WrongState(const SafetyParameters&, const LegModel&, double) noexcept { enter_run(); }
  void enter_run() noexcept { (*before_).setConstant(std::numeric_limits<double>::quiet_NaN()); }

  ConditionMeasurement measure(const LeggedMeasurements& now, const ConditionWatch& watch) noexcept {
    const Eigen::Vector3d by_gyro = *before_;
    *before_ = now.body.rate();
    if (now.input.state == nullptr || now.elapsed != 1) return kNothingMeasured;
    const Eigen::Map<const Eigen::Vector3d> by_state(now.input.state->base.twist_base.angular.data());
    return beyond(kMaxJoints, (by_state - by_gyro).norm(), watch.limit());
  }

 private:
  Stored<Eigen::Vector3d> before_;  ///< rad/s, ω_g
};

}  // namespace robot_control
