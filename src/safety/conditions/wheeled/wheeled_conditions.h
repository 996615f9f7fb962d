#pragma once
/// The conditions of a robot on wheels: how its wheels and its body move, compared with limits and targets. Limits that
/// are left out are not evaluated: call derived_limits (derived_limits.h) first.

#include "safety/conditions/common/body_conditions.h"
#include "safety/conditions/common/condition_set.h"
#include "safety/conditions/wheeled/not_stopping.h"
#include "safety/conditions/wheeled/stall.h"
#include "safety/conditions/wheeled/torque_oscillation.h"
#include "safety/conditions/wheeled/wheel_excess.h"
#include "safety/conditions/wheeled/wheel_limits.h"

namespace robot_control {

using WheeledConditions = ConditionSet<WheeledObserver,                                   //
                                       WheelLimits,                                       //
                                       WheelExcess<kCauseRunaway>,                        //
                                       WheelExcess<kCauseWrongDirection>,                 //
                                       WatchedCondition<kCauseStall, Stall>,              //
                                       WatchedCondition<kCauseNotStopping, NotStopping>,  //
                                       TorqueOscillation,                                 //
                                       BodyConditions>;

}  // namespace robot_control
