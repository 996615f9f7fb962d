#include "machine/wheeled/ground_points.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace robot_control {
namespace {

constexpr int kRimPoints = 16;

Eigen::Vector3d lowest(const WheelModel& wheel, const Eigen::Vector3d& axle) {
  // This is the support point of the ellipsoid (r, r, w/2) about its axle towards −z.
  const double half_width = wheel.width / 2;
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const double along = axle.dot(down);
  const Eigen::Vector3d across = down - along * axle;
  const Eigen::Vector3d scaled = wheel.radius * wheel.radius * across + half_width * half_width * along * axle;
  const double support = std::sqrt(down.dot(scaled));
  return Eigen::Vector3d(wheel.centre_base[0], wheel.centre_base[1], wheel.centre_base[2]) + scaled / support;
}

void add_cylinder(const Shape& shape, const Eigen::Isometry3d& in_base, std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d down = in_base.linear().transpose() * -Eigen::Vector3d::UnitZ();
  const double lowest_angle = std::atan2(down.y(), down.x());
  for (int i = 0; i < kRimPoints; ++i) {
    const double angle = lowest_angle + 2 * M_PI * i / kRimPoints;
    const Eigen::Vector3d rim(shape.radius * std::cos(angle), shape.radius * std::sin(angle), 0);
    for (const double end : {-0.5, 0.5})
      points.push_back(in_base * (rim + end * shape.length * Eigen::Vector3d::UnitZ()));
  }
}

void add_shape(const Shape& shape, const Eigen::Isometry3d& in_base, std::vector<Eigen::Vector3d>& points) {
  switch (shape.type) {
    case ShapeType::kSphere:
      points.push_back(in_base.translation() - shape.radius * Eigen::Vector3d::UnitZ());
      break;
    case ShapeType::kCylinder:
      add_cylinder(shape, in_base, points);
      break;
    case ShapeType::kBox:
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sign((corner & 1) ? 0.5 : -0.5, (corner & 2) ? 0.5 : -0.5, (corner & 4) ? 0.5 : -0.5);
        points.push_back(in_base * sign.cwiseProduct(shape.size));
      }
      break;
    case ShapeType::kMesh:
      for (const Eigen::Vector3d& point : shape.points) points.push_back(in_base * point);
      break;
  }
}

}  // namespace

const WheelModel* rolling_body(const DriveTrain& robot, const RigidBody& body) {
  for (const std::vector<WheelModel>* wheels : {&robot.wheels, &robot.casters}) {
    for (const WheelModel& wheel : *wheels) {
      if (robot.joints[wheel.joint].child_link == body.name) return &wheel;
    }
  }
  return nullptr;
}

std::vector<Eigen::Vector3d> ground_points(const DriveTrain& robot, const RigidBody& body) {
  if (const WheelModel* wheel = rolling_body(robot, body))
    return {lowest(*wheel, body.in_root.linear() * body.joint.axis)};
  std::vector<Eigen::Vector3d> points;
  for (const Shape& shape : body.shapes) add_shape(shape, body.in_root * shape.in_body, points);
  return points;
}

std::vector<Eigen::Vector3d> ground_points(const DriveTrain& robot) {
  std::vector<Eigen::Vector3d> points;
  for (const RigidBody& body : robot.bodies->bodies)
    std::ranges::copy(ground_points(robot, body), std::back_inserter(points));
  return points;
}

double standing_height(const DriveTrain& robot) {
  const std::vector<Eigen::Vector3d> points = ground_points(robot);
  return -(*std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
            return a.z() < b.z();
          })).z();
}

}  // namespace robot_control
