#pragma once
/// A URDF text as urdfdom understands it, or a message that says what is wrong and where.

#include <urdf_world/types.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "description/markup/sideways_names.h"
#include "description/robot_description.h"

namespace robot_control {

struct UrdfDocument {
  std::string source;                    ///< for messages
  urdf::ModelInterfaceSharedPtr model;   ///< never null
  std::vector<std::string> joint_order;  ///< names as they stand in the file (urdfdom sorts by name)
  std::vector<std::string> link_order;   ///< likewise
  std::set<std::string> driven;          ///< joints (urdf_markup.h)
  std::vector<SidewaysName> sideways_names;
  std::set<std::string> sideways_plugins;             ///< their files (urdf_markup.h)
  std::set<std::string> steering_plugins;             ///< likewise
  std::set<std::string> unsaid_axes;                  ///< joints (urdf_markup.h)
  std::map<std::string, std::string> turned_origins;  ///< (urdf_markup.h)
};

/// Throws RobotError: what parse_markup refuses, or whatever urdfdom objects to, in its own words. What urdfdom would
/// print on the console goes into the message.
UrdfDocument parse_urdf(const RobotDescription& description);

}  // namespace robot_control
