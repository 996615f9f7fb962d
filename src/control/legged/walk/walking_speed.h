#pragma once
/// The gaits of a robot, and how fast its legs carry it in each of them.
///
///   gait   that of gait.h, scaled. Its lift is lower where a step in place would need more than kLiftSpeedShare of the speed
///          limit of a joint
///   speed  the largest one of the body at which the legs need at most kSpeedShare of what they can (leg_use.h). A
///          leg that is nearly straight does not push the body on. That holds either way, for a steady walk and for the
///          first stance after a change of gaits: a foot that ended a stance may have to bear for a whole one. The
///          slower gait of a change bounds its speed until the other one has lasted for a period. To the front and back
///          no gait is faster than 1.7 m/s √(l/kReferenceLeg): beyond it a trot loses its balance
///          (docs/evidence/legs.md)

#include <vector>

#include "control/legged/stand/nominal_stance.h"
#include "control/legged/walk/gait.h"
#include "control/legged/walk/leg_use.h"
#include "control/legged/walk/twist_limiter.h"
#include "machine/legs/leg_model.h"

namespace robot_control {

inline constexpr double kLiftSpeedShare = 0.35;

Gait gait_of(const LegModel& robot, const NominalStance& stance, const Gait& reference) noexcept;

using Speeds = std::vector<WalkingTwist>;

/// Returns, by gait, the largest speeds to the front, to the left, and turning, each of them alone; at least
/// kMinSpeed. `gaits` are those of `gait_of`.
Speeds walking_speeds(const LegModel& robot, const NominalStance& stance, const Gaits& gaits);

/// Returns after how many s at most a walk ends in an emergency. That is the time of the limits, a period of the
/// slowest gait, and kAllDown.
double walk_ending_time(const LegControllerParameters& parameters, const LegModel& robot);

inline constexpr double kAllDown = 0.15;  ///< s, for which all feet stand before the joints hold the body

inline constexpr double kMinSpeed = 1e-3;  ///< m/s, rad/s

}  // namespace robot_control
