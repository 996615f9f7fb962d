#pragma once
/// The machine model is the description of any machine with moving joints, from which every node derives its numbers.
/// Robots of one kind have more, which stands on top of it: machine/wheeled/drive_train.h.
///
/// It is read from a URDF with urdfdom; positions come from a KDL tree at the zero pose. `base` is the frame of the
/// root link (REP 103: x forward, y left, z up).

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine/description/robot_description.h"
#include "machine/machine_parameters.h"
#include "signals/geometry.h"

namespace robot_control {

enum class JointRole {
  kDriven,   ///< driven by the controller of the robot's kind
  kPassive,  ///< not driven: no effort limit is given, it follows another joint, or the robot's kind leaves it free
  kHeld,     ///< has an actuator that the controller does not drive (arm, lift, gripper), and is always braked
};

/// Returns "driven", "passive" or "held".
constexpr const char* name_of(JointRole role) noexcept {
  constexpr std::array<const char*, 3> kNames{"driven", "passive", "held"};
  return kNames[static_cast<std::size_t>(role)];
}

/// Holds a range in rad or m, lower < upper.
struct JointRange {
  double lower = 0;
  double upper = 0;
};

/// Describes a moving joint and its actuator.
struct JointModel {
  std::string name;
  std::string child_link;
  double effort_limit = 0;    ///< N·m or N; 0 for passive joints, above 0 for others
  double velocity_limit = 0;  ///< rad/s or m/s; 0: unknown
  JointRole role = JointRole::kDriven;
  double damping = 0;                              ///< N·m·s/rad or N·s/m, bearing and gear
  double friction = 0;                             ///< N·m or N, dry friction
  std::optional<JointRange> range = std::nullopt;  ///< end stops; none: it turns without end
  bool prismatic = false;                          ///< true: m, m/s, N; false: rad, rad/s, N·m
  double effort_rate = 0;                          ///< N·m/s or N/s; 0: unlimited
  double acceleration_limit = 0;                   ///< rad/s² or m/s², of a commanded velocity; 0: unlimited
  double rotor_inertia = 0;  ///< kg·m² or kg, of a rotor times its gear ratio squared, which the URDF leaves out
  double rest_position = 0;  ///< rad or m, in which a simulator sets the machine down
};

/// Joints that have a name together, as the wheels of one side or the joints of one leg.
struct JointGroup {
  std::string name;                 ///< "left"
  std::vector<std::size_t> joints;  ///< indices into MachineModel::joints
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

/// The model of one kind is derived from it.
struct MachineModel {
  MachineModel() = default;
  MachineModel(const MachineModel&) = default;
  MachineModel(MachineModel&&) = default;
  MachineModel& operator=(const MachineModel&) = default;
  MachineModel& operator=(MachineModel&&) = default;
  virtual ~MachineModel() = default;

  /// Returns what the machine moves on, in words: "four legs of 0.426 m".
  virtual std::string parts() const { return std::to_string(joints.size()) + " joints"; }

  std::string name;
  std::string source;
  std::string urdf;        ///< the text itself
  std::uint64_t hash = 0;  ///< hash of the URDF text and every override; equal hash = same robot

  /// These joints are in the order of the frames' joint arrays: that of the file, unless the robot's kind sorts them.
  std::vector<JointModel> joints;

  std::vector<JointGroup> groups;  ///< set by the robot's kind; of joints that it drives

  double mass = 0;                   ///< kg, all links
  Vector3 centre_of_gravity_base{};  ///< m
  std::string base_link;             ///< the root link
  std::string imu_link;              ///< empty: the IMU sits in base_link
  Pose imu_in_base;                  ///< orientation rotates from IMU axes to base axes

  /// These bodies may touch the ground, in the order of SensorFrame::contacts. Each is named by the link that its
  /// joint moves. They are the ends of the tree that have a shape, unless the robot's kind chooses them.
  std::vector<std::string> contacts;

  std::shared_ptr<const RigidBodies> bodies;  ///< links and their bodies, for a simulator; not null after reading
  std::vector<RobotNote> notes;
};

/// Return the joints with role kDriven, and those that have an actuator (driven and held ones), as indices into
/// MachineModel::joints.
std::vector<std::size_t> driven_joint_indices(const MachineModel& machine);
std::vector<std::size_t> actuated_joint_indices(const MachineModel& machine);

/// Reads any machine whose joints move. A joint with an effort limit is kHeld until the robot's kind drives it.
///
/// Throws RobotError for a machine without moving joints, for overrides that are not finite or not above zero, and what
/// read_rigid_bodies, refuse_too_many_joints and imu_link_of refuse.
MachineModel read_machine(const RobotDescription& description, const MachineParameters& parameters);

}  // namespace robot_control
