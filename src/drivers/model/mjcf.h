#pragma once
/// The robot as MJCF text, alone or in a scene.
///
/// One MuJoCo body per rigid body, its inertia given explicitly, so the mass is that of the URDF. The root floats.
///
/// Shapes. A drive wheel, and a caster's wheel that rolls, is one ellipsoid (radius, radius, half its width) about
/// its axle, whatever the shapes of its body: it rolls true on planes where a cylinder scrubs on two edges. Every
/// other shape is what it is, a mesh the hull of its corners; a hull flatter than 1 mm, which has no volume that
/// MuJoCo accepts, is thickened to that. The robot's shapes do not collide with each other, as URDF means it.
///
/// Contact is hard, as measured not to creep: `solref .004 1`, `solimp .99 .999 .001`. All shapes but wheels are
/// frictionless (condim 1, which `priority 1` carries through): casters slide, a chassis glides off. So are wheels
/// on brush tyres, whose friction is wheel_contacts.h's. With native friction a wheel has condim 3 and the friction
/// of the ground: MuJoCo takes the larger of two shapes, the robot's is zero. Its `solmix` outweighs the ground's
/// solver settings.
///
/// Joints. Limits, damping and friction are the URDF's; a wheel has no stops. A wheel's rotor is its `armature`,
/// and motor_damping · gear_ratio², motor_friction · gear_ratio add to its losses. A suspension's spring pulls
/// towards q₀ = load / stiffness. A mimic joint is tied to what it follows by an equality. A joint that another device
/// else drives (JointRole::kHeld) is held by dry friction of its effort limit, or the robot's weight times 1 m where
/// that is unknown: unconditionally stable, whatever it carries. A caster's swivel gets an armature of 2 % of
/// (a quarter of the robot) · r²: the stiffness of the wheel's tyre is bound by the inertia behind it (tyre.h).
///
/// Every attribute that a scene's `<default>` could change is written out, all directions are quaternions (the
/// scene's `<compiler>` sets the unit of angles: ranges and spring angles of turning joints are `apply_angles`').

#include <mujoco/mujoco.h>

#include <array>
#include <optional>
#include <string>

#include "drivers/mujoco_plant_parameters.h"
#include "robot/bodies/rigid_bodies.h"
#include "robot/robot_model.h"

namespace robot_control {

/// Names inside the MuJoCo model; joints and bodies bear their URDF names, but for what MuJoCo itself calls "world".
inline constexpr const char* kMjcfImu = "robot_control/imu";
inline constexpr const char* kMjcfGyro = "robot_control/gyro";
inline constexpr const char* kMjcfStart = "start";

/// The body that the joint of this link moves.
std::string mjcf_body_name(const std::string& link);

/// The names of the rolling shapes: "robot_control/wheel/0" … in the order of RobotModel::wheels, then the casters'.
std::string mjcf_wheel_name(std::size_t wheel);

struct MjcfPlace {
  std::string scene_file;                           ///< included; empty: the robot alone
  std::array<double, 7> pose{0, 0, 0, 1, 0, 0, 0};  ///< of the base: x y z, quaternion w x y z
};

/// `robot` is the true one (true_robot.h). A scene's name is relative to the directory the text is loaded from.
std::string robot_mjcf(const RobotModel& robot, const MujocoPlantParameters& parameters, const MjcfPlace& place);

/// What the text cannot say without knowing the scene's unit of angles: ranges and spring angles of turning joints.
void apply_angles(const RobotModel& robot, mjModel& model);

}  // namespace robot_control
