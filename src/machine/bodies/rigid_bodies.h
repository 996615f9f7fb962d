#pragma once
/// A rigid body lumps the links of a URDF that fixed joints join together.
///
///   m = Σ mᵢ    c = Σ mᵢ cᵢ / m    I = Σ Rᵢ Iᵢ Rᵢᵀ + mᵢ (|dᵢ|² 1 − dᵢ dᵢᵀ),  dᵢ = cᵢ − c
///
/// A body's frame is that of the link that its joint moves (the root link's for body 0), at the zero pose.
///
/// A link without <inertial> has no mass. A moving body in which no link has mass is treated by one of two rules:
///   it rolls or carries something that rolls   it takes kMasslessShare of its parent body's mass, as a solid wheel of
///                                              its own shape or as a ball of kBallRadius
///   otherwise                                  it is welded to its parent, and its joint counts as fixed
/// An inertia whose radius of gyration (gyration.h) exceeds the size of the whole robot is scaled down to that size.
/// The shapes are those of <collision>. A robot without any, and a turning body without one that is round about its
/// joint, use those of <visual>. All of this is noted.

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "machine/description/markup/sideways_names.h"
#include "machine/machine_model.h"

namespace robot_control {

enum class ShapeType { kSphere, kCylinder, kBox, kMesh };

/// Describes a collision shape. The axis of a cylinder is its z.
struct Shape {
  ShapeType type = ShapeType::kSphere;
  Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();
  double radius = 0;                               ///< m; sphere, cylinder
  double length = 0;                               ///< m; cylinder
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< m, full lengths; box
  std::vector<Eigen::Vector3d> points;             ///< m, shape frame; mesh: corners of its convex hull, scaled
  std::string link;                                ///< link of the shape, for messages
};

enum class JointType { kRoot, kFixed, kRevolute, kContinuous, kPrismatic };

struct BodyJoint {
  std::string name;
  JointType type = JointType::kRoot;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit, body axes
  double effort_limit = 0;                          ///< N·m or N; 0: passive
  double velocity_limit = 0;                        ///< rad/s or m/s
  double lower = 0, upper = 0;                      ///< rad or m; revolute and prismatic; equal: no limit
  double damping = 0;                               ///< N·m·s/rad or N·s/m
  double friction = 0;                              ///< N·m or N
  double spring_stiffness = 0;  ///< N/m or N·m/rad, assumed for a suspension, because a URDF cannot state it
  double spring_load = 0;       ///< N or N·m along q: force = load − stiffness · q
  std::string mimicked;         ///< joint that this one follows; empty: none
  double mimic_multiplier = 1, mimic_offset = 0;  ///< q = multiplier · q_mimicked + offset
  bool driven = false;  ///< A transmission, ros2_control or a drive plugin names the joint or its leader.
};

struct RigidBody {
  std::string name;        ///< name of the link that the joint moves
  std::size_t parent = 0;  ///< index; without meaning for body 0
  BodyJoint joint;         ///< joint to the parent
  Eigen::Isometry3d in_root = Eigen::Isometry3d::Identity();
  double mass = 0;                                              ///< kg
  Eigen::Vector3d centre_of_gravity = Eigen::Vector3d::Zero();  ///< m, body frame
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();            ///< kg·m², about the centre of gravity, body axes
  std::vector<Shape> shapes;
};

/// Describes the place of a link in the lumped bodies.
struct LinkPlace {
  std::size_t body = 0;
  Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();
};

struct RigidBodies {
  std::string name;
  std::string source;
  std::vector<RigidBody> bodies;  ///< parents before children; 0 is the root
  std::map<std::string, LinkPlace> links;
  std::vector<std::string> moving_joints;   ///< in the order of the file
  std::map<std::string, JointType> joints;  ///< all joints, also fixed ones
  std::vector<std::string> link_order;      ///< in the order of the file
  std::set<std::string> driven_joints;      ///< driven joints of all kinds (BodyJoint::driven)
  std::vector<SidewaysName> sideways_names;
  std::set<std::string> sideways_plugins;   ///< plugins that move a robot sideways (UrdfDocument)
  std::set<std::string> steering_plugins;   ///< plugins that steer wheels (UrdfDocument)
  std::set<std::string> unsaid_axes;        ///< joints without a given axis, which is then 1 0 0
  std::set<std::string> turned_joints;      ///< joints whose origin is turned by more than a whole turn
  std::vector<std::string> missing_meshes;  ///< messages about <collision> shapes that are left out (link_shapes.h)
  std::vector<std::string> massless;        ///< links without <inertial> whose joints count as fixed
  std::vector<RobotNote> notes;             ///< values that were assumed, repaired or ignored

  /// Returns the body that the joint moves; null if no moving joint has this name.
  const RigidBody* moved_by(const std::string& joint) const;
};

inline constexpr double kMasslessShare = 0.01;
inline constexpr double kMaxPlausible = 1e9;  ///< kg, m, kg·m²: larger numbers are refused

/// Throws RobotError for a moving body or a base with a stated mass of zero and for numbers beyond kMaxPlausible. It
/// also throws what parse_urdf, inertia_of, shapes_of and read_joint refuse. A revolute joint that may turn by more
/// than `endless` rad is taken as continuous.
RigidBodies read_rigid_bodies(const RobotDescription& description,
                              double endless = std::numeric_limits<double>::infinity());

/// Returns the bodies of all joints that move, whatever they weigh. The kind of a robot follows from them.
RigidBodies read_moving_bodies(const RobotDescription& description);

/// Returns the mass of all bodies in kg.
double total_mass(const RigidBodies& robot);

}  // namespace robot_control
