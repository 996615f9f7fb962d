#pragma once
/// These functions write the robot as MJCF text, alone or in a scene.
///
/// Each rigid body becomes one MuJoCo body with an explicit inertia, so that its mass is that of the URDF. The root
/// floats.
///
/// Shapes: a drive wheel or a caster's rolling wheel is one ellipsoid (radius, radius, half its width) about its axle,
/// whatever its body's shapes are. On planes it rolls without the scrub of a cylinder on two edges. All other shapes
/// are kept, with the name of their link in theirs: "robot_control/shape/NUMBER/LINK". A mesh becomes the hull of its
/// corners. A hull flatter than 1 mm is thickened to 1 mm, because MuJoCo refuses its volume. The robot's shapes do not
/// collide with each other, as in URDF.
///
/// Contacts are hard; these values were measured not to creep: `solref .004 1`, `solimp .99 .999 .001`. On a robot with
/// drive wheels all other shapes are frictionless (condim 1, enforced by `priority 1`), so that casters and chassis
/// slide. The shapes of a machine without wheels have the friction of the ground (condim 3), or ground_friction. Wheels
/// on brush tyres are also frictionless for MuJoCo; wheel_contacts.h adds their friction. With native friction a wheel
/// has condim 3. Its friction is that of the ground, because MuJoCo uses the larger of two values and the robot's is
/// zero. The robot's `solmix` outweighs the ground's solver settings.
///
/// Joints: limits, damping and friction are those of the URDF; a wheel has no end stops. A drive's rotor is the
/// `armature` of its joint, that of a held joint is assumed (true_robot.h). On driven joints motor_damping ·
/// gear_ratio² and motor_friction · gear_ratio add to the losses. A suspension's spring pulls towards q₀ = load /
/// stiffness. An equality ties a mimic joint to the joint that it follows. A caster's swivel gets an armature of 2 % of
/// a quarter of the robot's mass times r². The inertia behind a tyre bounds the tyre's stiffness (tyre.h).
///
/// Every attribute that a scene's `<default>` could change is written explicitly. All directions are quaternions,
/// because the scene's `<compiler>` sets the unit of angles. `apply_angles` sets ranges and spring angles of rotating
/// joints.

#include <mujoco/mujoco.h>

#include <array>
#include <string>

#include "drivers/mujoco/model/true_robot.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// These are names inside the MuJoCo model. Joints and bodies have their URDF names, except a body "world", a name that
/// MuJoCo reserves.
inline constexpr const char* kMjcfImu = "robot_control/imu";
inline constexpr const char* kMjcfGyro = "robot_control/gyro";
inline constexpr const char* kMjcfStart = "start";

/// Returns the name of the body that the joint of this link moves.
std::string mjcf_body_name(const std::string& link);

/// Returns the name of a rolling shape: "robot_control/wheel/0" … in the order of TrueRobot::wheels.
std::string mjcf_wheel_name(std::size_t wheel);

struct MjcfPlace {
  std::string scene_file;                           ///< scene that the text includes; empty: the robot alone
  std::array<double, 7> pose{0, 0, 0, 1, 0, 0, 0};  ///< pose of the base: x y z, quaternion w x y z
  std::string terrain;                              ///< shapes of the body world
  bool at_rest = false;                             ///< the bodies lie where their joints rest, not at zero
};

/// Returns the MJCF text of `robot`, the true one (true_robot.h). The scene's name is relative to the directory from
/// which the text is loaded.
std::string robot_mjcf(const TrueRobot& robot, const MujocoPlantParameters& parameters, const MjcfPlace& place);

/// Sets ranges and spring angles of rotating joints, which the text leaves out because it does not know the scene's
/// unit of angles.
void apply_angles(const TrueRobot& robot, mjModel& model);

}  // namespace robot_control
