#pragma once
/// Parses a URDF text with urdfdom, or reports what is wrong and where.

#include <urdf_world/types.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "machine/description/markup/free_root.h"
#include "machine/description/markup/sideways_names.h"
#include "machine/description/robot_description.h"

namespace robot_control {

struct UrdfDocument {
  std::string source;                    ///< for messages
  urdf::ModelInterfaceSharedPtr model;   ///< never null
  FreeRoot free_root;                    ///< parts of the file that are left out
  std::vector<std::string> joint_order;  ///< names in the order of the file (urdfdom sorts by name)
  std::vector<std::string> link_order;   ///< names in the order of the file
  std::set<std::string> driven;          ///< driven joints (urdf_markup.h)
  std::vector<SidewaysName> sideways_names;
  std::set<std::string> sideways_plugins;             ///< files of plugins that move sideways (urdf_markup.h)
  std::set<std::string> steering_plugins;             ///< files of plugins that steer (urdf_markup.h)
  std::set<std::string> unsaid_axes;                  ///< joints without a given axis (urdf_markup.h)
  std::map<std::string, std::string> turned_origins;  ///< elements turned by more than a whole turn (urdf_markup.h)
};

/// Throws RobotError for what parse_markup refuses, and for an error of urdfdom, in its own words. Messages that
/// urdfdom would print on the console become part of the error.
UrdfDocument parse_urdf(const RobotDescription& description);

}  // namespace robot_control
