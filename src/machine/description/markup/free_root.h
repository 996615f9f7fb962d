#pragma once
/// A floating or planar joint on an empty root link, often called `world`, says that the robot is free to move. Both
/// are left out: the joint's child is the base, and its origin has no use.

#include <tinyxml.h>

#include <string>

namespace robot_control {

/// Names the elements that are left out; all are empty if there are none.
struct FreeRoot {
  std::string joint;
  std::string type;  ///< floating or planar
  std::string link;  ///< the empty root link
  std::string base;  ///< child of the joint
};

/// Returns true for a floating or planar joint.
bool is_free(const TiXmlElement& joint);

/// Returns the joint that take_free_root removes; null: there is none. It is free, its parent is a root link without
/// <inertial>, <visual> and <collision>, and no other joint hangs on that link.
const TiXmlElement* free_joint(const TiXmlElement& robot);

/// Removes free_joint and its parent.
FreeRoot take_free_root(TiXmlElement& robot);

}  // namespace robot_control
