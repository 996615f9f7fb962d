#include "machine/bodies/massless.h"

#include "machine/bodies/link_inertia.h"
#include "machine/bodies/rolling.h"
#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

Eigen::Matrix3d solid_inertia(const RigidBody& body, const RollingMeasure& measure, double mass) {
  if (!measure.objection.empty()) return 0.4 * mass * kBallRadius * kBallRadius * Eigen::Matrix3d::Identity();
  const double radius = measure.radius;
  const double across = mass * (3 * radius * radius + measure.width * measure.width) / 12;
  const Eigen::Matrix3d along = body.joint.axis * body.joint.axis.transpose();
  return across * (Eigen::Matrix3d::Identity() - along) + mass * radius * radius / 2 * along;
}

}  // namespace

std::set<std::string> idle_massless_joints(const LumpedBodies& lumped) {
  const std::vector<RigidBody>& bodies = lumped.robot.bodies;
  std::vector<bool> needed(bodies.size(), false);
  for (std::size_t i = bodies.size(); i-- > 1;) {
    needed[i] = needed[i] || measure_wheel(bodies[i]).objection.empty();
    if (needed[i]) needed[bodies[i].parent] = true;
  }
  std::set<std::string> idle;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    if (!lumped.weighed[i] && !needed[i]) idle.insert(bodies[i].joint.name);
  }
  return idle;
}

void assign_massless_inertia(LumpedBodies& lumped) {
  RigidBodies& robot = lumped.robot;
  if (robot.bodies.size() > 1 && !(robot.bodies[0].mass > 0)) {
    refuse(robot.source, link_element(robot.bodies[0].name), "neither it nor anything fixed to it has a mass",
           "Give it an <inertial> with <mass> and <inertia>");
  }
  for (std::size_t i = 1; i < robot.bodies.size(); ++i) {
    RigidBody& body = robot.bodies[i];
    if (body.mass > 0) continue;
    if (lumped.weighed[i]) {
      refuse(robot.source, link_element(body.name), "it moves, and its mass is zero",
             "Give <mass value=\"kg\"/> above zero and an <inertia>, or make joint \"" + body.joint.name + "\" fixed");
    }
    RigidBody& parent = robot.bodies[body.parent];
    const RollingMeasure measure = measure_wheel(body);
    body.mass = kMasslessShare * parent.mass;
    body.centre_of_gravity = measure.objection.empty() ? measure.centre_in_body : Eigen::Vector3d::Zero();
    body.inertia = solid_inertia(body, measure, body.mass);
    parent.mass -= body.mass;
    parent.inertia *= 1 - kMasslessShare;
    robot.notes.push_back(
        {RobotNote::Kind::kAssumed, link_element(body.name),
         "it moves without an <inertial>: " + number(body.mass) + " kg taken from \"" + parent.name + "\""});
  }
}

}  // namespace robot_control
