#pragma once
/// Notes properties that a robot hardly has as suspicious:
///
///   lengths   wheels of kMaxWheelRadius or more, or a shape larger than kMaxPart: probably millimetres
///   masses    more than a block of steel with the size of the box about all shapes: probably grams
///   base      less than kLightBase of the mass is in the root and the parts fixed to it: a missing <inertial>
///   tipping   the first wheel lifts (tipping.h) below the deceleration of the wheels' given torque limits, at most g,
///             or below kUsualRamp if none is given; or a robot without springs has no support before or behind its
///             centre of gravity
///   wheels    their torque limits minus their joints' friction accelerate the robot by less than kWeak
///   limits    wheels of kFastRim or more at their velocity limit: probably degrees or turns; or wheels with unequal
///             limits
///   root      farther than kFar diagonals of the robot from its wheels: probably a world that the robot is fixed to
///   mecanum   the file mentions such wheels, and more than two drive

#include <string>

#include "machine/robot_model.h"

namespace robot_control {

inline constexpr double kMaxWheelRadius = 0.6;  ///< m, radius
inline constexpr double kMaxPart = 20;          ///< m
inline constexpr double kSteel = 7850;          ///< kg/m³
inline constexpr double kLightBase = 0.15;
inline constexpr double kUsualRamp = 2;  ///< m/s², default of max_linear_emergency_deceleration

inline constexpr double kWeak = 0.05;  ///< m/s², which an incline of 0.3° takes
inline constexpr double kFar = 2;
inline constexpr double kFastRim = 15;  ///< m/s
inline constexpr double kSameLimit = 0.01;

/// Adds the notes to a complete robot model.
void note_suspicions(RobotModel& robot);

/// Returns all suspicious notes in one sentence, for an error that they may explain; empty: none.
std::string suspicions_of(const RobotModel& robot);

}  // namespace robot_control
