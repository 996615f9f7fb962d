#pragma once
/// Limits the requested twist of a body that walks on three axes: to the front, to the left, and turning. The limits
/// are those of wheels (motion_limits.h).
///
/// The target is scaled by the largest s ≤ 1 with which each axis is within its speed limit, and Σ |xᵢ|/cᵢ ≤ 1, where
/// cᵢ is the speed that the legs allow on this axis alone. Each axis follows axis_limiter.h. Their limits are scaled so
/// that all arrive in the same step. In an emergency every axis stops as fast as its own limits allow.

#include <array>
#include <cstdint>

#include "control/common/limits/axis_limiter.h"
#include "control/common/limits/motion_limits.h"
#include "control/legged/leg_controller_parameters.h"

namespace robot_control {

/// m/s, m/s, rad/s.
using WalkingTwist = std::array<double, 3>;

/// Returns the limits of the three axes. Emergency decelerations and jerks are derived from the accelerations
/// (motion_limits.h).
std::array<MotionLimits, 3> twist_limits(const LegControllerParameters& parameters) noexcept;

/// Returns the way in m of a body that trots ahead with `speed` until it stands. It is that of the limits, as on wheels
/// (stop_distance.h), after half a period of the gait. The feet that were in the air land ahead of the body,
/// which moves to them. `leg_length` is in m.
double walking_stop_distance(const LegControllerParameters& parameters, double leg_length, double speed,
                             bool emergency) noexcept;

class TwistLimiter {
 public:
  struct State {
    std::array<AxisState, 3> axes{};
  };

  explicit TwistLimiter(const std::array<MotionLimits, 3>& limits) noexcept : limits_(limits) {}

  /// Moves towards the finite `target` over `dt` s. `capable`: c, > 0. `reasons`: bits of CommandReason and
  /// LeggedReason are added.
  WalkingTwist step(State& state, const WalkingTwist& target, const WalkingTwist& capable, bool emergency, double dt,
                    std::uint64_t& reasons) const noexcept;

 private:
  std::array<MotionLimits, 3> limits_;
};

}  // namespace robot_control
