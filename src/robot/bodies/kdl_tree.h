#pragma once
/// The kinematic tree of a URDF, and where its links are while every joint stands at zero.

#include <Eigen/Geometry>
#include <kdl/tree.hpp>
#include <map>
#include <string>

#include "description/urdf_document.h"

namespace robot_control {

/// One KDL segment per link but the root, named after the link. Throws RobotError for joints that a KDL joint
/// cannot say (floating, planar).
KDL::Tree kdl_tree(const UrdfDocument& document);

/// Link name → its frame in the root link's, the segments' poses chained at joint value zero. The root is identity.
/// (TreeFkSolverPos_recursive does the same, but asserts on a tree without a moving joint.)
std::map<std::string, Eigen::Isometry3d> links_at_zero(const KDL::Tree& tree);

}  // namespace robot_control
