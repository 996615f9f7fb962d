#pragma once
/// Which joints are the drive wheels, and which passive wheels roll along.
///
/// Named by `left_wheel_joints` and `right_wheel_joints`, both or neither, in any order. Else found. A candidate
///   rolls (wheel.h) on an axle that is lateral within kAxleTolerance;
///   reaches the floor: its lowest point is within kFloorTolerance of that of the lowest candidate, or within the
///     travel of its suspension;
///   carries no rollers (rollers.h) and does not stand behind a swivel (swivel.h), nor follow another joint by
///     <mimic>, but that of a wheel;
///   is not on the middle line, halfway between the outermost candidates.
/// Of the candidates those are the drive wheels that the URDF says are driven, a follower as its leader; where it says
/// so of none, all. They have to make pairs. A pair: one left and one right of the middle line, on one axle (Δx),
/// equally far out (Δ|y|) and of one radius, each within kPairTolerance of the wheel base or radius, or what they are
/// out of round. All pairs have one radius, and nothing level with them hangs in the air because its own is smaller.
/// Anything else is not guessed: the candidates are named, and what to set.
///
/// More than kMaxWheels candidates, of which the URDF drives none, are the rollers of a track: refused.
///
/// Left and right are determined by position, because names may be wrong. A contradicting name is noted.
///
/// All else that rolls near the floor is a caster. Its swivel turns it into the direction of travel by its trail
/// (swivel.h). Without a swivel the robot could turn only by dragging it sideways: it is taken for an omni wheel
/// (WheelModel::omni). With too short a trail it is no caster, but slides. Both are noted. What shows that the robot
/// is no differential drive at all: other_drives.h.

#include <string>
#include <vector>

#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

inline constexpr double kFloorTolerance = 0.005;  ///< m
inline constexpr double kPairTolerance = 0.01;

struct RollingBody {
  std::size_t body = 0;     ///< index into RigidBodies::bodies
  WheelModel wheel;         ///< without `joint`
  double out_of_round = 0;  ///< m (wheel.h)
};

struct DriveTrain {
  std::vector<RollingBody> wheels;   ///< left ones front to back, then right ones
  std::vector<RollingBody> casters;  ///< all other bodies that roll and reach the floor within kCasterTolerance
};

inline constexpr double kCasterTolerance = 0.03;  ///< m

/// Throws RobotError: no wheels, with the reason for each joint that looks like one; wheels that make no pairs; more
/// than kMaxWheels; names of joints that do not exist, are fixed, slide, are not lateral or round, stand on the wrong
/// side.
DriveTrain find_drive_train(const RigidBodies& robot, const RobotParameters& parameters, std::vector<RobotNote>& notes);

/// Takes the <mimic> of drive wheels away, and notes it: each has a drive of its own.
void release_followers(RigidBodies& robot, const DriveTrain& train, std::vector<RobotNote>& notes);

/// m, Δy of the left and right wheels' centres, mean over the axles
double wheel_base_of(const std::vector<RollingBody>& wheels);

/// 1 + 2 s/b (RobotModel::wheel_base_multiplier)
double scrub_multiplier(const std::vector<RollingBody>& wheels);

}  // namespace robot_control
