#pragma once
/// What the machine is: the one description that every node derives its numbers from.
///
/// Read from a URDF with urdfdom; positions through a KDL tree at the zero pose. `base` is the root link's
/// frame (REP 103: x forward, y left, z up).

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "description/robot_description.h"
#include "signals/geometry.h"

namespace robot_control {

/// What a user may say about the robot beside its URDF (the `robot:` block). It is what estimator and controller
/// use; a simulated plant stays as the URDF says. Where both give a value and these differ by more than 1 %, a note
/// reports it.
struct RobotParameters {
  std::vector<std::string> left_wheel_joints;           ///< both empty: found, see drive_wheels.h
  std::vector<std::string> right_wheel_joints;          ///< as many as left ones
  std::optional<double> wheel_base;                     ///< m, between left and right wheel centres
  std::optional<double> wheel_base_multiplier;          ///< effective over geometric wheel base; see RobotModel
  std::optional<double> wheel_radius;                   ///< m, every wheel
  std::optional<double> left_wheel_radius_multiplier;   ///< of the left wheels' radius, given or the URDF's
  std::optional<double> right_wheel_radius_multiplier;  ///< of the right wheels'
  std::optional<double> wheel_effort_limit;             ///< N·m, every wheel; holds for the simulated drive, too
  std::optional<double> wheel_velocity_limit;           ///< rad/s, every wheel
  std::optional<double> wheel_effort_rate;              ///< N·m/s, every wheel; empty: kEffortRise
  std::optional<double> mass;                           ///< kg
  std::optional<Vector3> centre_of_gravity;             ///< m, base axes
  std::string imu_link;                    ///< empty: found by its name, else the IMU is in the base (imu_place.h)
  std::optional<Vector3> imu_position;     ///< m, base axes
  std::optional<Vector3> imu_orientation;  ///< rad, roll, pitch, yaw of the IMU's axes in the base's, as URDF's rpy
};

enum class JointRole {
  kWheel,    ///< driven by the controller
  kPassive,  ///< not driven: swivel and wheel of a caster, suspension, rocker, follower of a mimic
  kHeld,     ///< driven by another controller (arm, lift, gripper): braked, always
};

/// s from no torque to the effort limit, if the torque rate of a wheel is not given. That is how long the
/// current of a motor needs: inductance over resistance is 0.1 … 1 ms for brushed motors of 10 … 200 W (maxon
/// catalogue, terminal inductance and resistance of the RE series), so no motor gets slower by it.
inline constexpr double kEffortRise = 0.001;

/// rad or m, lower < upper.
struct JointRange {
  double lower = 0;
  double upper = 0;
};

/// A moving joint, in the order of the frames' joint arrays: wheels first, in the order of RobotModel::wheels, then
/// the others as they stand in the file.
struct JointModel {
  std::string name;
  std::string child_link;
  double effort_limit = 0;    ///< N·m or N; 0 for passive joints, above 0 for wheels
  double velocity_limit = 0;  ///< rad/s or m/s; 0: none known
  JointRole role = JointRole::kWheel;
  double damping = 0;                              ///< N·m·s/rad or N·s/m, of its bearing and gear
  double friction = 0;                             ///< N·m or N, dry
  std::optional<JointRange> range = std::nullopt;  ///< end stops; none: turns without end
  bool prismatic = false;                          ///< m, m/s, N; else rad, rad/s, N·m
  double effort_rate = 0;                          ///< N·m/s or N/s; 0: unlimited
};

enum class Side { kLeft, kRight };

/// A wheel that rolls on a lateral axle.
struct WheelModel {
  std::size_t joint = 0;     ///< index into RobotModel::joints
  Vector3 centre_base{};     ///< m, centre of the wheel's shape
  double radius = 0;         ///< m
  double width = 0;          ///< m
  double sign = 1;           ///< +1: positive joint velocity drives forward
  double inertia = 0;        ///< kg·m² about the axle, rotor_inertia included
  double rotor_inertia = 0;  ///< kg·m², assumed of a drive whose URDF leaves it out (drive_wheels.h)
  Side side = Side::kLeft;
  bool omni = false;  ///< caster that nothing turns into the direction of travel: slides sideways without friction
};

inline constexpr std::size_t kMaxWheels = 8;

/// A note for the user about a value that was not simply taken from the URDF.
struct RobotNote {
  enum class Kind {
    kAssumed,     ///< the URDF is silent
    kRepaired,    ///< what it says is impossible
    kIgnored,     ///< it says something that has no use here
    kOverridden,  ///< the `robot:` block says otherwise by more than 1 %
    kSuspicious,  ///< taken as it stands, but look at it
  };
  Kind kind = Kind::kAssumed;
  std::string element;  ///< "<link name=\"…\">"
  std::string text;     ///< a sentence with value and unit, without a full stop
};

/// "assumed", "repaired", "ignored", "overridden", "suspicious"
const char* name_of(RobotNote::Kind kind);

struct RigidBodies;

struct RobotModel {
  std::string name;
  std::string source;
  std::string urdf;        ///< the text itself
  std::uint64_t hash = 0;  ///< of the URDF text and every override; equal hash = same robot
  std::vector<JointModel> joints;
  std::vector<WheelModel> wheels;  ///< left ones front to back, then right ones; wheels[i].joint == i
  double wheel_base = 0;           ///< m, distance between the left and right wheel centres, mean over the axles

  /// Effective over geometric wheel base: what the wheels' speed difference is to be divided by. 1 for one wheel a
  /// side. Wheels behind each other scrub in a turn. With xᵢ the axles' positions from their mean, b the wheel base and
  /// s the speed, per rad/s of turning, by which each tread slips along its rolling direction, axle i slips with
  /// (s, xᵢ); equal loads under isotropic Coulomb friction turn the robot steadily where
  ///   Σ (b s/2 − xᵢ²)/√(s² + xᵢ²) = 0,   multiplier 1 + 2 s/b:   1 + (L/b)² for two axles L apart.
  double wheel_base_multiplier = 1;

  double mass = 0;                            ///< kg, all links
  Vector3 centre_of_gravity_base{};           ///< m
  double yaw_inertia = 0;                     ///< kg·m² about the vertical through the middle of the axles
  std::string base_link;                      ///< the root link
  std::string imu_link;                       ///< empty: the IMU sits in base_link
  Pose imu_in_base;                           ///< orientation rotates from IMU axes to base axes
  std::vector<WheelModel> casters;            ///< passive wheels that roll; `side` and `sign` mean nothing
  std::shared_ptr<const RigidBodies> bodies;  ///< what a simulator needs; never null after read_robot
  std::vector<RobotNote> notes;

  /// m
  double effective_wheel_base() const noexcept { return wheel_base * wheel_base_multiplier; }
};

/// Throws RobotError: what read_rigid_bodies, find_drive_train, refuse_unheld_joints and imu_link_of refuse, overrides
/// that are not above zero, more than kMaxJoints moving joints, numbers beyond all bounds.
RobotModel read_robot(const RobotDescription& description, const RobotParameters& parameters);

}  // namespace robot_control
