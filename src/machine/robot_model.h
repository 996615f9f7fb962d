#pragma once
/// The robot model is the one description of the machine from which every node derives its numbers.
///
/// It is read from a URDF with urdfdom; positions come from a KDL tree at the zero pose. `base` is the frame of the
/// root link (REP 103: x forward, y left, z up).

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine/description/robot_description.h"
#include "machine/robot_parameters.h"
#include "signals/geometry.h"
#include "signals/wheeled/wheel_count.h"

namespace robot_control {

enum class JointRole {
  kWheel,    ///< driven by the controller
  kPassive,  ///< not driven: swivel and wheel of a caster, suspension, rocker, follower of a mimic
  kHeld,     ///< driven by another controller (arm, lift, gripper) and always braked
};

/// This is the time in s from no torque to the effort limit, if the torque rate of a wheel is not given. A motor's
/// current needs the inductance over the resistance, which is 0.1 … 1 ms for brushed motors of 10 … 200 W (maxon
/// catalogue, RE series). So the rate makes no motor slower.
inline constexpr double kEffortRise = 0.001;

/// Holds a range in rad or m, lower < upper.
struct JointRange {
  double lower = 0;
  double upper = 0;
};

/// Describes a moving joint. Joints are in the order of the frames' joint arrays. The wheels come first, in the order
/// of RobotModel::wheels. The others follow in the order of the file.
struct JointModel {
  std::string name;
  std::string child_link;
  double effort_limit = 0;    ///< N·m or N; 0 for passive joints, above 0 for wheels
  double velocity_limit = 0;  ///< rad/s or m/s; 0: unknown
  JointRole role = JointRole::kWheel;
  double damping = 0;                              ///< N·m·s/rad or N·s/m, bearing and gear
  double friction = 0;                             ///< N·m or N, dry friction
  std::optional<JointRange> range = std::nullopt;  ///< end stops; none: it turns without end
  bool prismatic = false;                          ///< true: m, m/s, N; false: rad, rad/s, N·m
  double effort_rate = 0;                          ///< N·m/s or N/s; 0: unlimited
};

enum class Side { kLeft, kRight };

/// Describes a wheel that rolls on a lateral axle.
struct WheelModel {
  std::size_t joint = 0;     ///< index into RobotModel::joints
  Vector3 centre_base{};     ///< m, centre of the wheel's shape
  double radius = 0;         ///< m
  double width = 0;          ///< m
  double sign = 1;           ///< +1: positive joint velocity drives forward
  double inertia = 0;        ///< kg·m² about the axle, rotor_inertia included
  double rotor_inertia = 0;  ///< kg·m², assumed if the URDF leaves the drive's rotor out (drive_wheels.h)
  Side side = Side::kLeft;
  bool omni = false;  ///< a caster without a swivel, which slides sideways without friction
};

/// Informs the user about a value that was not simply taken from the URDF.
struct RobotNote {
  enum class Kind {
    kAssumed,     ///< The URDF gives no value.
    kRepaired,    ///< The URDF's value is impossible.
    kIgnored,     ///< The URDF's value has no use here.
    kOverridden,  ///< The `robot:` block differs by more than 1 %.
    kSuspicious,  ///< The value is used, but the user should check it.
  };
  Kind kind = Kind::kAssumed;
  std::string element;  ///< "<link name=\"…\">"
  std::string text;     ///< a sentence with value and unit, without a full stop
};

/// Returns "assumed", "repaired", "ignored", "overridden" or "suspicious".
const char* name_of(RobotNote::Kind kind);

struct RigidBodies;

struct RobotModel {
  std::string name;
  std::string source;
  std::string urdf;        ///< the text itself
  std::uint64_t hash = 0;  ///< hash of the URDF text and every override; equal hash = same robot
  std::vector<JointModel> joints;
  std::vector<WheelModel> wheels;  ///< left ones front to back, then right ones; wheels[i].joint == i
  double wheel_base = 0;           ///< m, distance between the left and right wheel centres, mean over the axles

  /// This is the effective over the geometric wheel base, which relates the turn to the wheels' speed difference. It is
  /// 1 for one wheel a side. Wheels behind each other scrub in a turn. Let xᵢ be the axles' positions from their mean
  /// and b the wheel base. Per rad/s of turning, the tread of axle i slips by s along its rolling direction and by xᵢ
  /// across it. Equal loads under isotropic Coulomb friction turn the robot steadily if
  ///   Σ (b s/2 − xᵢ²)/√(s² + xᵢ²) = 0,   multiplier 1 + 2 s/b:   1 + (L/b)² for two axles L apart.
  double wheel_base_multiplier = 1;

  double mass = 0;                            ///< kg, all links
  Vector3 centre_of_gravity_base{};           ///< m
  double yaw_inertia = 0;                     ///< kg·m² about the vertical through the middle of the axles
  std::string base_link;                      ///< the root link
  std::string imu_link;                       ///< empty: the IMU sits in base_link
  Pose imu_in_base;                           ///< orientation rotates from IMU axes to base axes
  std::vector<WheelModel> casters;            ///< passive wheels that roll; `side` and `sign` have no meaning
  std::shared_ptr<const RigidBodies> bodies;  ///< bodies for a simulator; never null after read_robot
  std::vector<RobotNote> notes;

  /// Returns the effective wheel base in m.
  double effective_wheel_base() const noexcept { return wheel_base * wheel_base_multiplier; }
};

/// Throws RobotError for more than kMaxJoints moving joints, for overrides that are not above zero, and for numbers
/// beyond all bounds. It also throws what read_rigid_bodies, find_drive_train, refuse_unheld_joints and imu_link_of
/// refuse.
RobotModel read_robot(const RobotDescription& description, const RobotParameters& parameters);

}  // namespace robot_control
