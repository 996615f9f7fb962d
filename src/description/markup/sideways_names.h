#pragma once
/// What a URDF calls mecanum, omni or holonomic, in any case.
///
/// Looked at are the names of the robot, of links and joints, the files of meshes and of the document that xacro
/// expanded, and the macros that it called (expand_xacro.py). "nonholonomic" says nothing, nor does "omni" of cameras
/// and words that only begin so ("omniverse").

#include <tinyxml.h>

#include <string>
#include <vector>

namespace robot_control {

struct SidewaysName {
  std::string element;  ///< as messages name it: "<link name=\"…\">"
  std::string word;     ///< that it says
  std::string link;     ///< that it belongs to, of a joint its child; empty: to the whole robot
};

/// In the order of the file, first those of the whole robot.
std::vector<SidewaysName> sideways_names(const TiXmlElement& robot);

}  // namespace robot_control
