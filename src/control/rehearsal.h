#pragma once
/// A set of limits and gains drives in virtual time before it drives the robot.
///
/// The controller of drive_controller.h, with the set, drives a rigid robot without slip. It is the one that
/// feed_forward.h describes, solved for the accelerations, with the bus' order of events: the torque of cycle k acts
/// over [t_k+1, t_k+2). Per side with the mean torque τ' of its wheels in driving direction, d·q̇ + f·tanh(q̇/ε)
/// subtracted,
///
///   (τ'_right + τ'_left)/2 = (r·m/2h + J/r)·v̇ − r·m·x_c·ω²/2h
///   (τ'_right − τ'_left)/2 = (r·I/(h·b) + J·b_eff/2r)·ω̇ + r·m·x_c·v·ω/(h·b)
///
/// Motions: straight at full speed and at kSlowPart of it, turning on the spot likewise, and both axes at half speed;
/// each from rest until it is steady, then back to rest. Steady at full speed, 1 % of the weight pushes the right
/// side's wheels on for half a second: rolling resistance or a caster that swivels, which the loops must be strong
/// enough for. What is looked for is by how much a speed lies beyond both ends of its ramp for kExcessTime without a
/// break, in tolerances of
///
///   max(kExcessPart·|speed|, kLeastExcess)      speed: of the motion along that axis; where it is 0,
///                                               of the fastest rim
///
/// On the real robot 5 % for 50 ms is the promise: these leave a margin for tyres and encoders.

#include "control/drive_controller_parameters.h"
#include "control/planar_twist.h"
#include "robot/robot_model.h"

namespace robot_control {

inline constexpr double kExcessPart = 0.03;
inline constexpr double kExcessTime = 0.03;  ///< s

/// m/s of a rim. Friction that the description does not know, fed forward, is too much on the described robot: 2 % of a
/// small motor's torque make 0.014, the slow gains that identify.py proposes for a delay of 6 cycles 0.023.
inline constexpr double kLeastExcess = 0.025;

/// m/s of a rim, by which a robot that stops may swing back; the same gains make 0.027.
inline constexpr double kLeastReverse = 0.03;

inline constexpr double kSlowPart = 0.1;

/// The worst of a rehearsal.
struct Excess {
  PlanarTwist motion;     ///< what was asked for, m/s, rad/s
  bool turning = false;   ///< `reached` is an angular speed
  bool stopping = false;  ///< on the way back to rest
  double reached = 0;     ///< m/s or rad/s
  double times = 0;       ///< tolerances; above 1 is too much
};

/// `described` is what the controller is given beside the set, `plant` what it drives in truth. `period` s > 0.
/// Allocates, and takes some ms: for ordinary threads.
Excess rehearse(const DriveControllerParameters& parameters, const RobotModel& described, const RobotModel& plant,
                double period);

}  // namespace robot_control
