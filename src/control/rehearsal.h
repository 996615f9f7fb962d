#pragma once
/// Simulates a set of limits and gains in virtual time before the robot drives with it.
///
/// The controller of drive_controller.h, with the set, drives a rigid robot with encoders of kCounts
/// (quantisation_ripple.h), without slip: the model of feed_forward.h, solved for the accelerations, with the event
/// order of the bus: the torque of cycle k acts over [t_k+1, t_k+2). Per side, with τ' the mean torque of its wheels in
/// driving direction less d·q̇ + f·tanh(q̇/ε),
///
///   (τ'_right + τ'_left)/2 = (r·m/2h + J/r)·v̇ − r·m·x_c·ω²/2h
///   (τ'_right − τ'_left)/2 = (r·I/(h·b) + J·b_eff/2r)·ω̇ + r·m·x_c·v·ω/(h·b) + scrub
///
/// scrub: the mean torque of the strained treads of scrub.h, at kGroundFriction (ground_friction.h).
///
/// Motions: straight at full speed and at kSlowerParts of it, turning on the spot likewise, and both axes at half
/// speed; each from rest until it is steady, then back to rest. At steady full speed 1 % of the weight pushes the
/// wheels of the right side forwards for half a second: rolling resistance, or a caster that swivels; the loops must be
/// strong enough for it; and treads that scrub grip by a twentieth less. Result, of each axis of each motion, there and
/// back: by how much a speed stays outside its ramp for kExcessTime without interruption, in units of
///
///   max(kExcessPart·|speed|, kLeastExcess)      speed: of the motion along that axis; if that is 0, of the fastest rim
///
/// The promise for the real robot is 5 % for 50 ms; the limits here leave a margin for tyres and encoders.

#include <array>
#include <vector>

#include "control/drive_controller_parameters.h"
#include "control/planar_twist.h"
#include "robot/robot_model.h"

namespace robot_control {

inline constexpr double kExcessPart = 0.03;
inline constexpr double kExcessTime = 0.03;  ///< s

/// m/s of a rim. Measured friction that is fed forward is too much on the described robot; figures:
/// docs/evidence/derivations.md.
inline constexpr double kLeastExcess = 0.0235;

/// m/s of a rim, by which a stopping robot may move backwards; figures: docs/evidence/derivations.md.
inline constexpr double kLeastReverse = 0.03;

/// Of full speed: ramps that end while the loops have not yet found what feed-forward has too much, and long before.
inline constexpr std::array kSlowerParts{0.7, 0.3, 0.1};

/// The largest excess of one axis on the way to a motion, or back to rest.
struct Excess {
  PlanarTwist motion;     ///< requested, m/s, rad/s
  bool turning = false;   ///< `reached` is an angular speed
  bool stopping = false;  ///< on the way back to rest
  double reached = 0;     ///< m/s or rad/s
  double times = 0;       ///< in tolerances; above 1 the set is refused
};

/// Both axes of every motion, there and back, always in the same order. `described`: the robot model of the controller;
/// `plant`: the simulated robot. `period` s > 0. Allocates and takes some ms: not for the real-time thread.
std::vector<Excess> rehearse(const DriveControllerParameters& parameters, const RobotModel& described,
                             const RobotModel& plant, double period);

}  // namespace robot_control
