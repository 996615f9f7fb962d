#pragma once
/// What a robot hardly is, noted as suspicious:
///
///   lengths   wheels of kLargestWheel or more, or a shape larger than kLargestPart: millimetres
///   masses    more than a block of steel as large as the robot, the box about all its shapes: grams
///   base      less than kLightBase of the whole mass is in the root and what is fixed to it: an <inertial> is missing
///   tipping   the first wheel lifts (tipping.h) at less than the robot's own limit: what the wheels' given torque
///             limits brake it by, at most g; where none is given, kUsualRamp. Or nothing carries it before or behind
///             its centre of gravity, and it has no springs
///   wheels    their torque limits, less their joints' friction, accelerate the robot by less than kWeak
///   limits    wheels of kFastRim or more at their velocity limit: degrees or turns; or wheels of one robot with other
///             limits
///   root      farther than kFar diagonals of the robot from its wheels: a world that the robot is fixed to
///   mecanum   the file speaks of such wheels, and more than two drive

#include <string>

#include "robot/robot_model.h"

namespace robot_control {

inline constexpr double kLargestWheel = 0.6;  ///< m, radius
inline constexpr double kLargestPart = 20;    ///< m
inline constexpr double kSteel = 7850;        ///< kg/m³
inline constexpr double kLightBase = 0.15;
inline constexpr double kUsualRamp = 2;  ///< m/s², default of max_linear_emergency_deceleration

inline constexpr double kWeak = 0.05;  ///< m/s²; an incline of 0.3° holds it
inline constexpr double kFar = 2;
inline constexpr double kFastRim = 15;  ///< m/s
inline constexpr double kSameLimit = 0.01;

/// Of a robot that is complete.
void note_suspicions(RobotModel& robot);

/// All suspicious notes in one sentence, for an error that they may explain; empty: none.
std::string suspicions_of(const RobotModel& robot);

}  // namespace robot_control
