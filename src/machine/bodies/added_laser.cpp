#include "machine/bodies/added_laser.h"

#include <algorithm>
#include <string>

#include "machine/bodies/shape_support.h"

namespace robot_control {

RobotDescription with_laser(RobotDescription description, bool wanted) {
  const std::size_t end = description.text.rfind("</robot>");
  if (!wanted || end == std::string::npos) return description;
  const RigidBodies robot = read_rigid_bodies(description);
  if (robot.links.contains(kLaserLink)) return description;
  Eigen::AlignedBox3d body(Eigen::Vector3d::Zero()), all(Eigen::Vector3d::Zero());
  for (const RigidBody& each : robot.bodies) {
    for (const Shape& shape : each.shapes) {
      all.extend(box_of(each, shape));
      if (&each == &robot.bodies[0]) body.extend(box_of(each, shape));
    }
  }
  const double height = std::min(body.max().z() + kAboveBody, all.min().z() + kHighest);
  description.text.insert(end, "<link name=\"" + std::string(kLaserLink) +
                                   "\"/><joint name=\"laser_joint_of_simulation\" type=\"fixed\"><parent link=\"" +
                                   robot.bodies[0].name + "\"/><child link=\"" + kLaserLink + "\"/><origin xyz=\"0 0 " +
                                   std::to_string(height) + "\"/></joint>\n");
  return description;
}

}  // namespace robot_control
