#pragma once
/// Builds the kinematic tree of a URDF and finds the places of its links while every joint is at zero.

#include <Eigen/Geometry>
#include <kdl/tree.hpp>
#include <map>
#include <string>

#include "machine/description/urdf_document.h"

namespace robot_control {

/// Returns one KDL segment per link but the root, named after the link. Throws RobotError for joints that KDL does not
/// have (floating, planar).
KDL::Tree kdl_tree(const UrdfDocument& document);

/// Returns the frame of each link in that of the root, by link name, with all joints at zero. The root is the identity.
/// (TreeFkSolverPos_recursive does the same, but asserts on a tree without a moving joint.)
std::map<std::string, Eigen::Isometry3d> links_at_zero(const KDL::Tree& tree);

}  // namespace robot_control
