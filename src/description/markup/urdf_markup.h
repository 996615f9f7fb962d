#pragma once
/// The XML of a URDF, before urdfdom sees it.
///
/// urdfdom refuses, or prints messages about, elements that have no use here or whose meaning is clear. They are
/// repaired in the markup, so that only what is wrong is refused:
///   <material>, <safety_controller>, <calibration>, whatever stands beside <link> and <joint>   left out
///   <visual> without a shape, <axis> without `xyz`                                              left out
///   <limit> without effort or velocity                                                          0: unknown
///   <mesh scale="…"> that is not three numbers                                                  0 0 0: refused on use

#include <tinyxml.h>

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "description/robot_description.h"

namespace robot_control {

inline constexpr int kDeepest = 100;
inline constexpr std::size_t kMostLinks = 2000;  ///< what is built on them descends by recursion

/// Fills `xml` and returns its `<robot>`. Throws RobotError with the line: not well-formed, another or a second root
/// element, a joint whose type is unknown, floating or planar, a revolute joint without limits, a link with two
/// parents, links in a ring, elements nested deeper than kDeepest, more than kMostLinks links, a percent sign
/// outside file names; bytes that are not UTF-8, NUL characters, a git-LFS pointer, entities of its own, elements of
/// xacro.
TiXmlElement& parse_markup(const RobotDescription& description, TiXmlDocument& xml);

/// The joints that something drives, in the words of ROS 1, ROS 2 and Gazebo: named by a <transmission>, given a
/// <command_interface> in <ros2_control>, or named by a <plugin>: in an element that says left or right, or of a
/// plugin that is called a drive. Nothing else of these is used: their sides and numbers are wrong too often.
std::set<std::string> driven_joints(const TiXmlElement& robot);

/// The files of the <plugin>s, of Gazebo or ros2_control, whose file or name contains one of the words, in any case;
/// where there is no file, the name.
std::set<std::string> plugins_that_say(const TiXmlElement& robot, const std::vector<std::string>& words);

/// Of plugins that move a robot sideways, too, and of those that steer its wheels.
inline const std::vector<std::string> kSidewaysWords{"planar_move", "planarmove", "force_based_move", "mecanum",
                                                     "omni",        "holonomic",  "swerve",           "kiwi"};
inline const std::vector<std::string> kSteeringWords{"ackermann", "steer", "tricycle", "bicycle"};

/// The joints with an <axis> that has no `xyz`, as in <axis xzy="0 1 0">, and moving ones without an <axis>: theirs is
/// 1 0 0.
std::set<std::string> unsaid_axes(const TiXmlElement& robot);

/// The <joint>s, and the inertias and shapes of links, whose <origin rpy="…"> has an angle of more than a whole
/// turn, in words, and this text.
std::map<std::string, std::string> turned_origins(const TiXmlElement& robot);

/// As above.
void repair_markup(TiXmlElement& robot);

}  // namespace robot_control
