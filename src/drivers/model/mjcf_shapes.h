#pragma once
/// Collision shapes as MJCF elements; the rules are mjcf.h's.

#include <Eigen/Geometry>
#include <string>

#include "drivers/mujoco_plant_parameters.h"
#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

/// 17 digits, "." as decimal point: as text and back without a change.
std::string mjcf_number(double value);
std::string mjcf_numbers(const Eigen::Vector3d& values);

/// ` pos="…" quat="…"`
std::string mjcf_pose(const Eigen::Isometry3d& frame);

/// `<geom …/>` of a shape that slides; `mesh` names its asset.
std::string mjcf_sliding_shape(const Shape& shape, const std::string& mesh);

/// `<geom …/>` of a drive wheel or caster: `frame` has the axle as its z.
std::string mjcf_rolling_shape(const std::string& name, const Eigen::Isometry3d& frame, const WheelModel& wheel,
                               const MujocoPlantParameters& parameters);

/// `<mesh …/>` with its corners; flat ones thickened.
std::string mjcf_mesh(const std::string& name, const std::vector<Eigen::Vector3d>& corners);

}  // namespace robot_control
