#include "robot/rigid_bodies.h"

#include <urdf_model/model.h>

#include <Eigen/Eigenvalues>

#include "robot/kdl_tree.h"
#include "robot/urdf_document.h"

namespace robot_control {
namespace {

struct PointInertia {
  double mass = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
};

std::string link_element(const std::string& name) {
  return "<link name=\"" + name + "\">";
}

Eigen::Isometry3d eigen_pose(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const auto& q = pose.rotation;
  result.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

PointInertia inertia_of(const urdf::Link& link, const Eigen::Isometry3d& in_body, const std::string& source) {
  PointInertia result;
  if (!link.inertial) return result;
  const urdf::Inertial& given = *link.inertial;
  Eigen::Matrix3d tensor;
  tensor << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz, given.izz;
  if (!(given.mass >= 0)) {
    refuse(source, link_element(link.name), "mass " + std::to_string(given.mass) + " kg", "A mass is not negative");
  }
  const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvalues();
  const double tolerance = 1e-9 * principal.cwiseAbs().maxCoeff();  // rounding of decimal numbers in the file
  if (principal[0] < -tolerance || principal[0] + principal[1] < principal[2] - tolerance) {
    refuse(source, link_element(link.name),
           "<inertia>: principal moments " + std::to_string(principal[0]) + ", " + std::to_string(principal[1]) + ", " +
               std::to_string(principal[2]) + " kg·m² belong to no body",
           "They must not be negative, and the two smaller must sum to at least the largest");
  }
  const Eigen::Isometry3d frame = in_body * eigen_pose(given.origin);
  result.mass = given.mass;
  result.centre = frame.translation();
  result.inertia = frame.linear() * tensor * frame.linear().transpose();
  return result;
}

void add(RigidBody& body, const PointInertia& part) {
  const double mass = body.mass + part.mass;
  if (mass <= 0) return;
  const auto shifted = [](const Eigen::Matrix3d& inertia, double m, const Eigen::Vector3d& d) -> Eigen::Matrix3d {
    return inertia + m * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  };
  const Eigen::Vector3d centre = (body.mass * body.centre_of_gravity + part.mass * part.centre) / mass;
  body.inertia = shifted(body.inertia, body.mass, body.centre_of_gravity - centre) +
                 shifted(part.inertia, part.mass, part.centre - centre);
  body.centre_of_gravity = centre;
  body.mass = mass;
}

Shape shape_of(const urdf::Collision& collision, const Eigen::Isometry3d& in_body, const std::string& link) {
  Shape shape;
  shape.in_body = in_body * eigen_pose(collision.origin);
  shape.link = link;
  switch (collision.geometry->type) {
    case urdf::Geometry::SPHERE:
      shape.type = ShapeType::kSphere;
      shape.radius = static_cast<const urdf::Sphere&>(*collision.geometry).radius;
      break;
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(*collision.geometry);
      shape.type = ShapeType::kCylinder;
      shape.radius = cylinder.radius;
      shape.length = cylinder.length;
      break;
    }
    case urdf::Geometry::BOX: {
      const auto& dim = static_cast<const urdf::Box&>(*collision.geometry).dim;
      shape.type = ShapeType::kBox;
      shape.size = Eigen::Vector3d(dim.x, dim.y, dim.z);
      break;
    }
    case urdf::Geometry::MESH:
      shape.type = ShapeType::kMesh;
      break;
  }
  return shape;
}

BodyJoint joint_of(const urdf::Joint& joint) {
  BodyJoint result;
  result.name = joint.name;
  result.type = joint.type == urdf::Joint::CONTINUOUS ? JointType::kContinuous
                : joint.type == urdf::Joint::REVOLUTE ? JointType::kRevolute
                                                      : JointType::kPrismatic;
  result.axis = Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z).normalized();
  if (joint.limits) {
    result.effort_limit = joint.limits->effort;
    result.velocity_limit = joint.limits->velocity;
    result.lower = joint.limits->lower;
    result.upper = joint.limits->upper;
  }
  if (joint.dynamics) {
    result.damping = joint.dynamics->damping;
    result.friction = joint.dynamics->friction;
  }
  return result;
}

class Lumper {
 public:
  Lumper(const UrdfDocument& document, RigidBodies& result)
      : document_(document), result_(result), frames_(links_at_zero(kdl_tree(document))) {}

  void add_body(const urdf::Link& link, std::size_t parent, const BodyJoint& joint) {
    RigidBody body;
    body.name = link.name;
    body.parent = parent;
    body.joint = joint;
    body.in_root = frames_.at(link.name);
    result_.bodies.push_back(body);
    add_link(link, result_.bodies.size() - 1);
  }

 private:
  void add_link(const urdf::Link& link, std::size_t body) {
    const Eigen::Isometry3d in_body = result_.bodies[body].in_root.inverse() * frames_.at(link.name);
    result_.links[link.name] = {body, in_body};
    add(result_.bodies[body], inertia_of(link, in_body, document_.source));
    for (const auto& collision : link.collision_array) {
      if (collision && collision->geometry) {
        result_.bodies[body].shapes.push_back(shape_of(*collision, in_body, link.name));
      }
    }
    for (const std::string& name : document_.joint_order) {
      const urdf::Joint& joint = *document_.model->getJoint(name);
      if (joint.parent_link_name != link.name) continue;
      const urdf::Link& child = *document_.model->getLink(joint.child_link_name);
      if (joint.type == urdf::Joint::FIXED) {
        add_link(child, body);
      } else {
        add_body(child, body, joint_of(joint));
      }
    }
  }

  const UrdfDocument& document_;
  RigidBodies& result_;
  std::map<std::string, Eigen::Isometry3d> frames_;
};

}  // namespace

const RigidBody* RigidBodies::moved_by(const std::string& joint) const {
  for (const RigidBody& body : bodies) {
    if (body.joint.type != JointType::kRoot && body.joint.name == joint) return &body;
  }
  return nullptr;
}

RigidBodies read_rigid_bodies(const RobotDescription& description) {
  const UrdfDocument document = parse_urdf(description);
  RigidBodies result;
  result.name = document.model->getName();
  result.source = document.source;
  Lumper(document, result).add_body(*document.model->getRoot(), 0, {});

  for (const std::string& name : document.joint_order) {
    const bool moves = result.moved_by(name) != nullptr;
    result.joints[name] = moves ? result.moved_by(name)->joint.type : JointType::kFixed;
    if (moves) result.moving_joints.push_back(name);
  }
  for (const RigidBody& body : result.bodies) {
    if (body.mass <= 0) {
      refuse(document.source, link_element(body.name), "it moves but has no mass, nor has anything fixed to it",
             "Give it an <inertial> with <mass> and <inertia>");
    }
  }
  return result;
}

}  // namespace robot_control
