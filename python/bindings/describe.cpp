#include "bindings/describe.h"

#include <pybind11/stl.h>

#include <array>
#include <vector>

#include "machine/bodies/rigid_bodies.h"
#include "machine/description/mesh.h"
#include "machine/description/wording.h"

namespace py = pybind11;

namespace robot_control {
namespace {

const char* name_of(JointRole role) {
  constexpr std::array<const char*, 3> kNames{"wheel", "passive", "held"};
  return kNames.at(static_cast<std::size_t>(role));
}

const char* name_of(JointType type) {
  constexpr std::array<const char*, 5> kNames{"root", "fixed", "revolute", "continuous", "prismatic"};
  return kNames.at(static_cast<std::size_t>(type));
}

const char* name_of(ShapeType type) {
  constexpr std::array<const char*, 4> kNames{"sphere", "cylinder", "box", "mesh"};
  return kNames.at(static_cast<std::size_t>(type));
}

std::vector<double> plain(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

std::vector<std::vector<double>> plain(const Eigen::Isometry3d& pose) {
  std::vector<std::vector<double>> rows;
  for (Eigen::Index row = 0; row < 4; ++row) {
    rows.emplace_back();
    for (Eigen::Index column = 0; column < 4; ++column) rows.back().push_back(pose.matrix()(row, column));
  }
  return rows;
}

py::dict wheel_dict(const DriveTrain& robot, const WheelModel& wheel) {
  using namespace py::literals;
  return py::dict("joint"_a = robot.joints.at(wheel.joint).name, "centre"_a = wheel.centre_base,
                  "radius"_a = wheel.radius, "width"_a = wheel.width, "inertia"_a = wheel.inertia,
                  "rotor_inertia"_a = wheel.rotor_inertia);
}

py::dict joint_dict(const DriveTrain& robot, const JointModel& joint) {
  using namespace py::literals;
  const BodyJoint& moved = robot.bodies->moved_by(joint.name)->joint;
  return py::dict("name"_a = joint.name, "link"_a = joint.child_link, "role"_a = name_of(joint.role),
                  "type"_a = name_of(moved.type), "driven"_a = moved.driven, "effort_limit"_a = joint.effort_limit,
                  "velocity_limit"_a = joint.velocity_limit, "lower"_a = moved.lower, "upper"_a = moved.upper,
                  "mimicked"_a = moved.mimicked);
}

py::dict shape_dict(const RigidBody& body, const Shape& shape) {
  using namespace py::literals;
  std::vector<std::vector<double>> points;
  for (const Eigen::Vector3d& point : shape.points) points.push_back(plain(point));
  return py::dict("link"_a = shape.link, "joint"_a = body.joint.name, "type"_a = name_of(shape.type),
                  "in_base"_a = plain(body.in_root * shape.in_body), "radius"_a = shape.radius,
                  "length"_a = shape.length, "size"_a = plain(shape.size), "points"_a = points,
                  "triangles"_a = hull_triangles(shape.points));
}

}  // namespace

py::dict describe(const DriveTrain& robot) {
  using namespace py::literals;
  py::list wheels, casters, joints, shapes, notes;
  for (const WheelModel& wheel : robot.wheels) {
    py::dict entry = wheel_dict(robot, wheel);
    entry["side"] = wheel.side == Side::kLeft ? "left" : "right";
    entry["sign"] = wheel.sign;
    wheels.append(entry);
  }
  for (const WheelModel& caster : robot.casters) casters.append(wheel_dict(robot, caster));
  for (const JointModel& joint : robot.joints) joints.append(joint_dict(robot, joint));
  for (const RigidBody& body : robot.bodies->bodies) {
    for (const Shape& shape : body.shapes) shapes.append(shape_dict(body, shape));
  }
  for (const RobotNote& note : robot.notes) {
    notes.append(py::dict("kind"_a = name_of(note.kind), "element"_a = note.element, "text"_a = note.text));
  }
  const py::dict imu("link"_a = robot.imu_link, "position"_a = robot.imu_in_base.position,
                     "orientation"_a = robot.imu_in_base.orientation);
  return py::dict("name"_a = robot.name, "source"_a = robot.source, "base_link"_a = robot.base_link,
                  "mass"_a = robot.mass, "yaw_inertia"_a = robot.yaw_inertia,
                  "centre_of_gravity"_a = robot.centre_of_gravity_base, "wheel_base"_a = robot.wheel_base,
                  "wheel_base_multiplier"_a = robot.wheel_base_multiplier,
                  "effective_wheel_base"_a = robot.effective_wheel_base(), "imu"_a = imu, "wheels"_a = wheels,
                  "casters"_a = casters, "joints"_a = joints, "shapes"_a = shapes, "notes"_a = notes);
}

}  // namespace robot_control
