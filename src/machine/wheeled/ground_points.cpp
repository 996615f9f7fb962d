#include "machine/wheeled/ground_points.h"

#include <algorithm>
#include <iterator>

namespace robot_control {

RollingEllipsoid ellipsoid_of(const WheelModel& wheel) {
  return {.centre_base = wheel.centre_base, .radius = wheel.radius, .width = wheel.width};
}

const WheelModel* rolling_body(const DriveTrain& robot, const RigidBody& body) {
  for (const std::vector<WheelModel>* wheels : {&robot.wheels, &robot.casters}) {
    for (const WheelModel& wheel : *wheels) {
      if (robot.joints[wheel.joint].child_link == body.name) return &wheel;
    }
  }
  return nullptr;
}

std::vector<Eigen::Vector3d> ground_points(const DriveTrain& robot, const RigidBody& body) {
  const WheelModel* const wheel = rolling_body(robot, body);
  if (wheel == nullptr) return shape_points(body, nullptr);
  const RollingEllipsoid rolling = ellipsoid_of(*wheel);
  return shape_points(body, &rolling);
}

std::vector<Eigen::Vector3d> ground_points(const DriveTrain& robot) {
  std::vector<Eigen::Vector3d> points;
  for (const RigidBody& body : robot.bodies->bodies)
    std::ranges::copy(ground_points(robot, body), std::back_inserter(points));
  return points;
}

double standing_height(const DriveTrain& robot) {
  return height_above(ground_points(robot));
}

}  // namespace robot_control
