#pragma once
/// Checks and repairs the XML of a URDF before urdfdom parses it.
///
/// urdfdom refuses elements that have no use here or whose meaning is clear, or prints messages about them. They are
/// repaired in the markup, so that only real errors are refused:
///   <material>, <safety_controller>, <calibration>, all elements beside <link> and <joint>        left out
///   <visual> without a shape, <axis> without `xyz`                                              left out
///   <limit> without effort or velocity                                                          0: unknown
///   <mesh scale="…"> that is not three numbers                                                  0 0 0: refused on use

#include <tinyxml.h>

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "machine/description/robot_description.h"

namespace robot_control {

inline constexpr int kDeepest = 100;
inline constexpr std::size_t kMaxShapes = 4000;  ///< <collision> and <visual> together
inline constexpr std::size_t kMaxLinks = 2000;   ///< bound for code that descends the tree by recursion

/// Fills `xml` and returns its `<robot>`. Throws RobotError with the line in these cases:
///   - text: bytes that are not UTF-8, NUL characters, a git-LFS pointer, entities of its own
///   - markup: not well-formed, another or a second root element, elements nested deeper than kDeepest, elements of
///     xacro, a percent sign outside file names
///   - joints: an unknown type, a floating or planar one that is not free_joint (free_root.h), a revolute joint without
///   limits
///   - links: two parents, a ring, more than kMaxLinks, more than kMaxShapes shapes
TiXmlElement& parse_markup(const RobotDescription& description, TiXmlDocument& xml);

/// Returns the joints that the file drives, in the formats of ROS 1, ROS 2 and Gazebo. A <transmission> names the
/// joint, or it has a <command_interface> in <ros2_control>. Or a <plugin> names it: in an element that says left or
/// right, or in a plugin called a drive. The other contents of these elements are not used, because they are often
/// wrong.
std::set<std::string> driven_joints(const TiXmlElement& robot);

/// Returns the files of the <plugin>s, of Gazebo or ros2_control, whose file or name contains one of the words, in any
/// case. A plugin without a file is returned by its name.
std::set<std::string> plugins_that_say(const TiXmlElement& robot, const std::vector<std::string>& words);

/// These words are in the names of plugins that move a robot sideways, and of those that steer its wheels.
inline const std::vector<std::string> kSidewaysWords{"planar_move", "planarmove", "force_based_move", "mecanum",
                                                     "omni",        "holonomic",  "swerve",           "kiwi"};
inline const std::vector<std::string> kSteeringWords{"ackermann", "steer", "tricycle", "bicycle"};

/// Returns the joints with an <axis> that has no `xyz`, as in <axis xzy="0 1 0">, and moving ones without an <axis>.
/// Their axis is 1 0 0.
std::set<std::string> unsaid_axes(const TiXmlElement& robot);

/// Returns elements whose <origin rpy="…"> has an angle of more than a whole turn, with that text. The elements are
/// joints and the inertias and shapes of links.
std::map<std::string, std::string> turned_origins(const TiXmlElement& robot);

/// Repairs the markup as above.
void repair_markup(TiXmlElement& robot);

}  // namespace robot_control
