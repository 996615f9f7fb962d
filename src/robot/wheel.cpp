#include "robot/wheel.h"

#include <cmath>

#include "robot/urdf_document.h"

namespace robot_control {
namespace {

std::string list(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += (result.empty() ? "" : ", ") + name;
  return result.empty() ? "none" : result;
}

const RigidBody& turning_body(const RigidBodies& robot, const std::string& joint) {
  const std::string element = "<joint name=\"" + joint + "\">";
  const auto found = robot.joints.find(joint);
  if (found == robot.joints.end()) {
    refuse(robot.source, element, "there is no such joint (moving joints: " + list(robot.moving_joints) + ")",
           "Name the wheels' joints by robot/left_wheel_joint and robot/right_wheel_joint");
  }
  if (found->second == JointType::kFixed) {
    refuse(robot.source, element, "it is fixed, a wheel has to turn", "Make it type=\"continuous\"");
  }
  if (found->second != JointType::kContinuous && found->second != JointType::kRevolute) {
    refuse(robot.source, element, "it slides, a wheel has to turn", "Make it type=\"continuous\"");
  }
  return *robot.moved_by(joint);
}

double angle_between_lines(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

}  // namespace

const Shape* rolling_shape(const RigidBody& body) {
  const Shape* largest = nullptr;
  for (const Shape& shape : body.shapes) {
    if (shape.type != ShapeType::kCylinder && shape.type != ShapeType::kSphere) continue;
    if (largest == nullptr || shape.radius > largest->radius) largest = &shape;
  }
  return largest;
}

WheelModel measure_wheel(const RigidBodies& robot, const std::string& joint) {
  const RigidBody& body = turning_body(robot, joint);
  const std::string joint_element = "<joint name=\"" + joint + "\">";
  const std::string link_element = "<link name=\"" + body.name + "\">";

  const Eigen::Vector3d axle = body.in_root.linear() * body.joint.axis;
  const double tilt = angle_between_lines(axle, Eigen::Vector3d::UnitY());
  if (tilt > kAxleTolerance) {
    refuse(robot.source, joint_element,
           "its axis is " + std::to_string(tilt * 180 / M_PI) + "° off the lateral (y) axis of " +
               robot.bodies[0].name + ", 0.2° are allowed",
           "Turn <axis> or the joint's <origin rpy>");
  }
  if (!(body.joint.effort_limit > 0) || !(body.joint.velocity_limit > 0)) {
    refuse(robot.source, joint_element, "it has no effort or velocity limit",
           "Add <limit effort=\"N·m\" velocity=\"rad/s\"/>, both above zero");
  }

  const Shape* shape = rolling_shape(body);
  if (shape == nullptr) {
    refuse(robot.source, link_element, "there is no collision cylinder or sphere to take the wheel's radius from",
           "Add <collision><geometry><cylinder radius=\"m\" length=\"m\"/></geometry></collision>");
  }
  if (!(shape->radius > 0) || (shape->type == ShapeType::kCylinder && !(shape->length > 0))) {
    refuse(robot.source, link_element, "its collision shape has no size", "Give radius and length above zero");
  }
  const Eigen::Vector3d centre = shape->in_body.translation();
  const bool upright = shape->type == ShapeType::kSphere ||
                       angle_between_lines(shape->in_body.linear().col(2), body.joint.axis) <= kAxleTolerance;
  const double offset = centre.cross(body.joint.axis).norm();
  if (!upright || offset > kAxleTolerance * shape->radius) {
    refuse(robot.source, link_element, "its collision shape does not lie around the axle",
           "Turn and move the <collision>'s <origin> so that the axle is the axis of the cylinder");
  }

  const Eigen::Vector3d lever = body.centre_of_gravity.cross(body.joint.axis);
  const Eigen::Vector3d centre_base = body.in_root * centre;
  WheelModel wheel;
  wheel.centre_base = {centre_base.x(), centre_base.y(), centre_base.z()};
  wheel.radius = shape->radius;
  wheel.width = shape->type == ShapeType::kCylinder ? shape->length : 2 * shape->radius;
  wheel.sign = axle.y() > 0 ? 1 : -1;
  wheel.inertia = body.joint.axis.dot(body.inertia * body.joint.axis) + body.mass * lever.squaredNorm();
  return wheel;
}

}  // namespace robot_control
