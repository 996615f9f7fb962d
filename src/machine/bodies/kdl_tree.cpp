#include "machine/bodies/kdl_tree.h"

#include <urdf_model/model.h>

#include <kdl/frames.hpp>
#include <kdl/segment.hpp>

namespace robot_control {
namespace {

KDL::Frame kdl_frame(const urdf::Pose& pose) {
  const auto& q = pose.rotation;
  return {KDL::Rotation::Quaternion(q.x, q.y, q.z, q.w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

KDL::Joint kdl_joint(const UrdfDocument& document, const urdf::Joint& joint) {
  const KDL::Frame frame = kdl_frame(joint.parent_to_joint_origin_transform);
  const KDL::Vector axis = frame.M * KDL::Vector(joint.axis.x, joint.axis.y, joint.axis.z);
  switch (joint.type) {
    case urdf::Joint::FIXED:
      return KDL::Joint(joint.name, KDL::Joint::None);
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
      return {joint.name, frame.p, axis, KDL::Joint::RotAxis};
    case urdf::Joint::PRISMATIC:
      return {joint.name, frame.p, axis, KDL::Joint::TransAxis};
    default:
      refuse(document.source, "<joint name=\"" + joint.name + "\">", "floating and planar joints are not supported",
             "Set type to fixed, revolute, continuous or prismatic");
  }
}

void add_children(const UrdfDocument& document, const urdf::Link& link, KDL::Tree& tree) {
  for (const auto& child : link.child_links) {
    const urdf::Joint& joint = *child->parent_joint;
    tree.addSegment(
        KDL::Segment(child->name, kdl_joint(document, joint), kdl_frame(joint.parent_to_joint_origin_transform)),
        link.name);
    add_children(document, *child, tree);
  }
}

Eigen::Isometry3d eigen_frame(const KDL::Frame& frame) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result(row, column) = frame.M(row, column);
    result(row, 3) = frame.p(row);
  }
  return result;
}

void add_frames(KDL::SegmentMap::const_iterator element, const KDL::Frame& frame,
                std::map<std::string, Eigen::Isometry3d>& frames) {
  frames.emplace(element->first, eigen_frame(frame));
  for (const auto& child : GetTreeElementChildren(element->second)) {
    add_frames(child, frame * GetTreeElementSegment(child->second).pose(0), frames);
  }
}

}  // namespace

KDL::Tree kdl_tree(const UrdfDocument& document) {
  const urdf::Link& root = *document.model->getRoot();
  KDL::Tree tree(root.name);
  add_children(document, root, tree);
  return tree;
}

std::map<std::string, Eigen::Isometry3d> links_at_zero(const KDL::Tree& tree) {
  std::map<std::string, Eigen::Isometry3d> frames;
  add_frames(tree.getRootSegment(), KDL::Frame::Identity(), frames);
  return frames;
}

}  // namespace robot_control
