#pragma once
/// Finds names in a URDF that contain mecanum, omni or holonomic, in any case.
///
/// It checks the names of the robot, of links and joints, the files of meshes, and the document and macros that xacro
/// expanded (expand_xacro.py). It ignores "nonholonomic", and "omni" in names of cameras and in other words
/// ("omniverse").

#include <tinyxml.h>

#include <string>
#include <vector>

namespace robot_control {

struct SidewaysName {
  std::string element;  ///< as messages name it: "<link name=\"…\">"
  std::string word;     ///< word that the name contains
  std::string link;     ///< link of the name; a joint's child; empty: the whole robot
};

/// Returns the names in the order of the file, first those of the whole robot.
std::vector<SidewaysName> sideways_names(const TiXmlElement& robot);

}  // namespace robot_control
