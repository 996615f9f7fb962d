#pragma once
/// Notes properties that a robot on wheels hardly has as suspicious, beside those of suspicions.h:
///
///   lengths   wheels of kMaxWheelRadius or more: probably millimetres
///   tipping   the first wheel lifts (tipping.h) below the deceleration of the wheels' given torque limits, at most g,
///             or below kUsualRamp if none is given; or a robot without springs has no support before or behind its
///             centre of gravity
///   wheels    their torque limits minus their joints' friction accelerate the robot by less than kMinAcceleration
///   limits    wheels of kFastRim or more at their velocity limit: probably degrees or turns; or wheels with unequal
///             limits
///   root      farther than kMaxRootDistance diagonals of the robot from its wheels: probably a world that the robot is fixed to
///   casters   a joint with an effort limit that carries the wheel of a caster and is no swivel, suspension or
///   follower:
///             nothing holds it
///   free      a joint without effort limit, spring and leader that carries no wheel: nothing holds it
///   mecanum   the file mentions such wheels, and more than two drive

#include "machine/wheeled/drive_train.h"

namespace robot_control {

inline constexpr double kMaxWheelRadius = 0.6;  ///< m, radius
inline constexpr double kUsualRamp = 2;         ///< m/s², default of max_linear_emergency_deceleration

inline constexpr double kMinAcceleration = 0.05;  ///< m/s², which an incline of 0.3° takes
inline constexpr double kMaxRootDistance = 2;
inline constexpr double kFastRim = 15;  ///< m/s
inline constexpr double kSameLimit = 0.01;

/// Adds the notes to a complete robot model, those of suspicions.h included.
void note_suspicions(DriveTrain& robot);

}  // namespace robot_control
