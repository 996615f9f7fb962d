#pragma once
/// These functions write collision shapes as MJCF elements by the rules in mjcf.h.

#include <Eigen/Geometry>
#include <string>

#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

struct TrueWheel;

/// Return numbers with 17 digits and the decimal point ".", which are read back without a change.
std::string mjcf_number(double value);
std::string mjcf_numbers(const Eigen::Vector3d& values);

/// Returns ` pos="…" quat="…"`.
std::string mjcf_pose(const Eigen::Isometry3d& frame);

/// Returns `<geom …/>` of a shape that is no wheel; `mesh` names its asset. It slides without friction, or has the
/// ground's.
enum class Grip { kNone, kGround };
std::string mjcf_shape(const std::string& name, const Shape& shape, const std::string& mesh, Grip grip,
                       const MujocoPlantParameters& parameters);

/// Returns `<geom …/>` of a drive wheel or caster; the z axis of `frame` is the axle.
std::string mjcf_rolling_shape(const std::string& name, const Eigen::Isometry3d& frame, const TrueWheel& wheel,
                               const MujocoPlantParameters& parameters);

/// Returns `<mesh …/>` with its corners; flat meshes are thickened.
std::string mjcf_mesh(const std::string& name, const std::vector<Eigen::Vector3d>& corners);

}  // namespace robot_control
