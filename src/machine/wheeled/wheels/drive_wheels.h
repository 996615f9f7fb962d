#pragma once
/// Finds the drive wheels and the passive wheels that roll along.
///
/// Drive wheels are named by `left_wheel_joints` and `right_wheel_joints`, both or neither, in any order. Otherwise
/// they are found. A candidate
///   rolls (rolling.h) on an axle that is lateral within kAxleTolerance;
///   reaches the floor: its lowest point is within kFloorTolerance of that of the lowest candidate, or within the
///     travel of its suspension;
///   carries no rollers (rollers.h), is not behind a swivel (swivel.h), and follows no other joint than that of a wheel
///     by <mimic>;
///   is not on the middle line, halfway between the outermost candidates.
/// The drive wheels are the candidates that the URDF drives, followers included, or all candidates if it drives none.
/// They must make pairs. The two wheels of a pair are left and right of the middle line, on one axle (Δx) and equally
/// far out (Δ|y|). They have one radius. The tolerance is kPairTolerance of the wheel base or radius, or the wheels'
/// out-of-roundness. All pairs have one radius, and no smaller wheel with its hub level with theirs may hang in the
/// air. Otherwise the robot is refused, with the candidates and the parameters to set.
///
/// More than kMaxWheels candidates, of which the URDF drives none, are the rollers of a track and are refused. Left and
/// right follow from the position, because names may be wrong; a contradicting name is noted.
///
/// Any other wheel near the floor is a caster. Its swivel turns it into the direction of travel by its trail
/// (swivel.h). Without a swivel a turn would drag it sideways, so it counts as an omni wheel (WheelModel::omni). With
/// too short a trail it slides. Both are noted. other_drives.h refuses robots that are no differential drives.

#include <vector>

#include "machine/bodies/rolling.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

inline constexpr double kFloorTolerance = 0.005;  ///< m
inline constexpr double kPairTolerance = 0.01;

struct RollingBody {
  std::size_t body = 0;     ///< index into RigidBodies::bodies
  WheelModel wheel;         ///< without `joint`
  double out_of_round = 0;  ///< m, out-of-roundness (rolling.h)
};

/// Returns the body with its measure as a wheel. Its sign is +1 if the axle points left; the caller sets its side.
RollingBody rolling_body_of(std::size_t body, const RollingMeasure& measure);

struct RunningGear {
  std::vector<RollingBody> wheels;   ///< left ones front to back, then right ones
  std::vector<RollingBody> casters;  ///< all other bodies that roll and reach the floor within kCasterTolerance
};

inline constexpr double kCasterTolerance = 0.03;  ///< m

/// Throws RobotError if there are no wheels, with the reason for each joint that looks like one. It throws, too, for
/// wheels that make no pairs and for more than kMaxWheels. Named joints are refused if they do not exist, are fixed,
/// slide, are not lateral or round, or are on the wrong side.
RunningGear find_running_gear(const RigidBodies& robot, const DriveTrainParameters& parameters,
                              std::vector<RobotNote>& notes);

/// Removes the <mimic> of drive wheels and notes it: each has a drive of its own.
void release_followers(RigidBodies& robot, const RunningGear& gear, std::vector<RobotNote>& notes);

/// Returns the mean Δy of the left and right wheels' centres over the axles, m.
double wheel_base_of(const std::vector<RollingBody>& wheels);

/// Returns 1 + 2 s/b (DriveTrain::wheel_base_multiplier).
double scrub_multiplier(const std::vector<RollingBody>& wheels);

}  // namespace robot_control
