#include "bindings/describe.h"

#include <pybind11/stl.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "bindings/wheeled/describe_wheels.h"
#include "control/legged/stand/nominal_stance.h"
#include "machine/bodies/posed_bodies.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/description/mesh.h"
#include "machine/description/wording.h"
#include "machine/legs/leg_model.h"

namespace py = pybind11;

namespace robot_control {
namespace {

/// `driven` is the word for a joint that the controller drives.
const char* name_of(JointRole role, const char* driven) {
  const std::array<const char*, 3> names{driven, "passive", "held"};
  return names.at(static_cast<std::size_t>(role));
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

py::dict joint_dict(const MachineModel& robot, const JointModel& joint, const char* driven) {
  using namespace py::literals;
  const BodyJoint& moved = robot.bodies->moved_by(joint.name)->joint;
  return py::dict("name"_a = joint.name, "link"_a = joint.child_link, "role"_a = name_of(joint.role, driven),
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

/// Returns what every robot has; `bodies` are those to be shown.
py::dict machine_dict(const MachineModel& robot, const RigidBodies& bodies, const char* kind, const char* driven) {
  using namespace py::literals;
  py::list joints, shapes, notes;
  for (const JointModel& joint : robot.joints) joints.append(joint_dict(robot, joint, driven));
  for (const RigidBody& body : bodies.bodies) {
    for (const Shape& shape : body.shapes) shapes.append(shape_dict(body, shape));
  }
  for (const RobotNote& note : robot.notes) {
    notes.append(py::dict("kind"_a = name_of(note.kind), "element"_a = note.element, "text"_a = note.text));
  }
  const py::dict imu("link"_a = robot.imu_link, "position"_a = robot.imu_in_base.position,
                     "orientation"_a = robot.imu_in_base.orientation);
  return py::dict("kind"_a = kind, "name"_a = robot.name, "source"_a = robot.source, "base_link"_a = robot.base_link,
                  "mass"_a = robot.mass, "centre_of_gravity"_a = robot.centre_of_gravity_base, "imu"_a = imu,
                  "joints"_a = joints, "shapes"_a = shapes, "notes"_a = notes);
}

py::dict leg_dict(const LegModel& robot, std::size_t leg) {
  using namespace py::literals;
  const LegKinematics& kinematics = robot.legs[leg].kinematics;
  const LegGeometry& geometry = kinematics.geometry();
  std::vector<std::string> joints;
  for (std::size_t i = 0; i < kLegJoints; ++i) joints.push_back(robot.joints[kLegJoints * leg + i].name);
  const LegAngles& lying = robot.legs[leg].lying;
  return py::dict(
      "place"_a = robot_control::name_of(static_cast<LegPlace>(leg)), "joints"_a = joints,
      "hip"_a = plain(geometry.hip), "knee"_a = plain(Eigen::Vector3d(geometry.hip + geometry.upper + geometry.lower)),
      "foot"_a = plain(kinematics.position(LegAngles::Zero())), "foot_radius"_a = robot.legs[leg].foot_radius,
      "length"_a = kinematics.length(), "bends"_a = geometry.bend > 0 ? "forward" : "backward",
      "lying"_a = plain(lying), "lying_foot"_a = plain(kinematics.position(lying)));
}

/// Returns the robot as it stands.
py::dict standing_dict(const LegModel& robot, const NominalStance& stance) {
  using namespace py::literals;
  std::map<std::string, double> angles;
  for (std::size_t i = 0; i < kLegsJoints; ++i) angles[robot.joints[i].name] = stance.motion.angles[i];
  py::list places;
  for (const RigidBody& body : posed(*robot.bodies, angles).bodies) {
    for (const Shape& shape : body.shapes) places.append(plain(body.in_root * shape.in_body));
  }
  return py::dict("floor"_a = robot.belly - nominal_height(robot),
                  "centre_of_gravity"_a = plain(stance.equations.centre_of_gravity), "in_base"_a = places);
}

py::dict describe_legs(const LegModel& robot) {
  py::dict result = machine_dict(robot, resting(*robot.bodies, robot.joints), "legs", "leg");
  py::list legs;
  for (std::size_t leg = 0; leg < kLegs; ++leg) legs.append(leg_dict(robot, leg));
  result["belly"] = robot.belly;
  const NominalStance stance = nominal_stance(robot);
  if (!stance.short_leg) result["upright"] = standing_dict(robot, stance);
  result["rotor_inertia"] = robot.rotor_inertia;
  result["legs"] = legs;
  return result;
}

}  // namespace

py::dict describe(const MachineModel& robot) {
  if (const auto* const legged = dynamic_cast<const LegModel*>(&robot)) return describe_legs(*legged);
  py::dict result = machine_dict(robot, *robot.bodies, "wheels", "wheel");
  describe_wheels(robot, result);
  return result;
}

}  // namespace robot_control
