#include "machine/wheeled/feet.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "machine/bodies/shape_support.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

constexpr double kNotedHeight = 1e-6;  // m

struct Extent {
  double low = 0, high = 0;  ///< m
};

/// Returns the extent of a shape along an axis of the root.
Extent extent(const RigidBody& body, const Shape& shape, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d in_body = body.in_root.linear().transpose() * axis;
  const double origin = body.in_root.translation().dot(axis);
  return {origin - support(shape, -in_body), origin + support(shape, in_body)};
}

bool rolls(const RunningGear& gear, std::size_t body) {
  const auto is_it = [body](const RollingBody& rolling) { return rolling.body == body; };
  return std::any_of(gear.wheels.begin(), gear.wheels.end(), is_it) ||
         std::any_of(gear.casters.begin(), gear.casters.end(), is_it);
}

bool is_footprint(const RigidBodies& robot, const RigidBody& body, const Shape& shape, double floor) {
  const bool is_root = shape.link == robot.bodies[0].name;
  if (!is_root && lower_case(shape.link).find("footprint") == std::string::npos) return false;
  const Eigen::Vector3d origin = (body.in_root * robot.links.at(shape.link).in_body).translation();
  if (std::abs(origin.z() - floor) > kFloorTolerance) return false;
  for (int axis = 0; axis < 2; ++axis) {
    const Extent side = extent(body, shape, Eigen::Vector3d::Unit(axis));
    if (origin[axis] < side.low || origin[axis] > side.high) return false;
  }
  const Extent height = extent(body, shape, Eigen::Vector3d::UnitZ());
  return height.low <= floor + kHeightTolerance && height.high <= floor + kThin && height.high - height.low <= kThin;
}

void leave_out_footprints(RigidBodies& robot, const RunningGear& gear, double floor, std::vector<RobotNote>& notes) {
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
    RigidBody& body = robot.bodies[i];
    if (rolls(gear, i)) continue;
    std::erase_if(body.shapes, [&](const Shape& shape) {
      if (!is_footprint(robot, body, shape, floor)) return false;
      notes.push_back({RobotNote::Kind::kIgnored, link_element(shape.link) + "<collision>",
                       "a thin shape on the floor only marks the footprint: ignored"});
      return true;
    });
  }
}

void note_levelled(const std::string& link, double gap, std::vector<RobotNote>& notes) {
  if (std::abs(gap) < kNotedHeight) return;
  notes.push_back({RobotNote::Kind::kAssumed, link_element(link),
                   "it ends " + number(std::abs(gap) * 1000) + " mm " + (gap < 0 ? "below" : "above") +
                       " the drive wheels: assumed level with them"});
}

void raise(RigidBodies& robot, std::size_t body, double by) {
  for (std::size_t i = body; i < robot.bodies.size(); ++i) {
    std::size_t ancestor = i;
    while (ancestor > body) ancestor = robot.bodies[ancestor].parent;
    if (ancestor == body) robot.bodies[i].in_root.translation().z() += by;
  }
}

}  // namespace

double floor_height(const RunningGear& gear) {
  double floor = 0;
  for (const RollingBody& wheel : gear.wheels) {
    floor += (wheel.wheel.centre_base[2] - wheel.wheel.radius) / static_cast<double>(gear.wheels.size());
  }
  return floor;
}

void set_feet(RigidBodies& robot, RunningGear& gear, std::vector<RobotNote>& notes) {
  const double floor = floor_height(gear);
  leave_out_footprints(robot, gear, floor, notes);
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
    RigidBody& body = robot.bodies[i];
    if (rolls(gear, i)) continue;
    for (Shape& shape : body.shapes) {
      const double gap = extent(body, shape, Eigen::Vector3d::UnitZ()).low - floor;
      if (std::abs(gap) > kHeightTolerance) continue;
      shape.in_body.translation() -= gap * (body.in_root.linear().transpose() * Eigen::Vector3d::UnitZ());
      note_levelled(shape.link, gap, notes);
    }
  }
  for (RollingBody& caster : gear.casters) {
    const double gap = caster.wheel.centre_base[2] - caster.wheel.radius - floor;
    if (std::abs(gap) > kHeightTolerance) continue;
    caster.wheel.centre_base[2] -= gap;
    raise(robot, caster.body, -gap);
    note_levelled(robot.bodies[caster.body].name, gap, notes);
  }
}

}  // namespace robot_control
