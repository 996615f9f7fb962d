#pragma once
/// The conditions of a robot on legs compare body, joints and feet with their limits, and the state with the gyro.

#include "safety/conditions/common/body_conditions.h"
#include "safety/conditions/common/condition_set.h"
#include "safety/conditions/legged/downward_force.h"
#include "safety/conditions/legged/encoder_conditions.h"
#include "safety/conditions/legged/joint_conditions.h"
#include "safety/conditions/legged/legged_observer.h"
#include "safety/conditions/legged/wrong_state.h"

namespace robot_control {

using FootConditions = ConditionList<WatchedCondition<kCauseFootSlip, Stateless<&LeggedMeasurements::foot_slip>>,
                                     WatchedCondition<kCauseFootLoad, Stateless<&LeggedMeasurements::foot_load>>,
                                     WatchedCondition<kCauseSinking, Stateless<&LeggedMeasurements::sinking>>,
                                     WatchedCondition<kCauseBodyTurn, Stateless<&LeggedMeasurements::body_turn>>>;

using LeggedConditions =
    ConditionSet<LeggedObserver,                                                                                      //
                 BodyConditions,                                                                                      //
                 WatchedCondition<kCauseImuReversed, DownwardForce>, WatchedCondition<kCauseWrongState, WrongState>,  //
                 JointConditions,                                                                                     //
                 EncoderConditions,                                                                                   //
                 FootConditions>;

/// Returns limits with a limit of foot_slip, where none is given: one leg length per second.
inline SafetyParameters legged_limits(const SafetyParameters& given, const LegModel& robot) {
  SafetyParameters limits = given;
  if (!limits.foot_slip.limit) limits.foot_slip.limit = robot.leg_length();
  return limits;
}

}  // namespace robot_control
