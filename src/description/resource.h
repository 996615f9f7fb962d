#pragma once
/// Where the files are that a URDF refers to.

#include <filesystem>
#include <string>

#include "description/robot_description.h"

namespace robot_control {

/// The file behind the `filename` of a `<mesh>`:
///
///   package://PACKAGE/PATH   below the folder of the package
///   file:///PATH             with %20 and its like decoded
///   /PATH                    as it stands
///   PATH                     below the folder of the URDF, when description.source is a file
///
/// A package is looked for in this order and the first hit counts. What a folder of the search path holds is
/// remembered until the process ends.
///   1. ROS_PACKAGE_PATH as rospack crawls it: a folder with a package.xml or manifest.xml is a package and is not
///      searched further, nor are hidden folders, those with CATKIN_IGNORE or rospack_nosubdirs, or more than
///      kPackageDepth levels; a package's name is that in package.xml, else its folder's;
///   2. share/PACKAGE in each prefix of CMAKE_PREFIX_PATH;
///   3. beside the URDF and above it: a folder on the way up that is the package, or has one of its name with a
///      package.xml or with the file.
///
/// Throws RobotError, naming what was looked for and where: an unknown package, a file that is not there, another
/// scheme, no name at all.
std::filesystem::path resolve_resource(const std::string& uri, const RobotDescription& description);

inline constexpr int kPackageDepth = 8;  ///< levels of folders below an entry of ROS_PACKAGE_PATH

}  // namespace robot_control
