#pragma once
/// The robot as MJCF text, to be added to a scene.
///
/// One MuJoCo body per rigid body, its inertia given explicitly, so the mass is that of the URDF. The root floats.
/// Contact, as measured to roll true on planes: a wheel is an ellipsoid (radius, radius, half its width) with a
/// hard contact, `solref .004 1`, `solimp .99 .999 .001`, condim 3. MuJoCo takes the larger friction of two
/// shapes; the robot's is zero, so the friction of the ground counts. Its `solmix` outweighs the ground's
/// solver settings. A sphere that is not a wheel is a ball caster: frictionless, `priority 1`. The robot's shapes
/// do not collide with each other.
///
/// Every attribute that a scene's `<default>` could change is written out, all directions are quaternions (the
/// scene's `<compiler>` sets the unit of angles).

#include <string>

#include "robot/rigid_bodies.h"

namespace robot_control {

/// Names inside the MuJoCo model; joints and bodies bear their URDF names.
inline constexpr const char* kMjcfImu = "robot_control/imu";
inline constexpr const char* kMjcfGyro = "robot_control/gyro";
inline constexpr const char* kMjcfAccelerometer = "robot_control/accelerometer";
inline constexpr const char* kMjcfStart = "start";

/// A model that includes `scene_file` (a name relative to the directory the text is loaded from) and the robot.
/// Throws DriverError for shapes that the plant cannot simulate (meshes).
std::string robot_mjcf(const RigidBodies& robot, const RobotModel& model, const std::string& scene_file);

/// Height of the root frame above the plane on which wheels and casters stand.
double standing_height(const RigidBodies& robot, const RobotModel& model);

/// The names of the wheel shapes: "robot_control/wheel/0" left, "…/1" right.
std::string mjcf_wheel_name(std::size_t wheel);

}  // namespace robot_control
