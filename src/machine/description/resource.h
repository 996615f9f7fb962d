#pragma once
/// Finds the files that a URDF refers to.

#include <filesystem>
#include <string>

#include "machine/description/robot_description.h"

namespace robot_control {

/// Returns the file behind the `filename` of a `<mesh>`:
///
///   package://PACKAGE/PATH   below the folder of the package
///   file:///PATH             with %20 and similar codes decoded
///   /PATH                    used unchanged
///   PATH                     below the folder of the URDF, if description.source is a file
///
/// A package is searched in this order, and the first hit counts. The packages of a search path are cached until the
/// process ends.
///   1. ROS_PACKAGE_PATH as rospack crawls it: a folder with a package.xml or manifest.xml is a package and is not
///      searched further. Hidden folders, those with CATKIN_IGNORE or rospack_nosubdirs, and more than kPackageDepth
///      levels are not searched. A package's name is that in package.xml, else its folder's.
///   2. share/PACKAGE in each prefix of CMAKE_PREFIX_PATH.
///   3. The URDF's folder and those above it: one that is the package, or contains a folder of its name with a
///      package.xml or with the file.
///
/// Throws RobotError with the searched name and places for an unknown package and for a missing file. Another scheme
/// and an empty name are refused, too.
std::filesystem::path resolve_resource(const std::string& uri, const RobotDescription& description);

inline constexpr int kPackageDepth = 8;  ///< levels of folders below an entry of ROS_PACKAGE_PATH

}  // namespace robot_control
