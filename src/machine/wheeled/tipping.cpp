#include "machine/wheeled/tipping.h"

#include <algorithm>
#include <cmath>

#include "machine/gravity.h"
#include "machine/wheeled/ground_points.h"

namespace robot_control {
namespace {

constexpr double kSettlingTilt = 3 * M_PI / 180;

}  // namespace

double lifting_deceleration(const DriveTrain& robot) {
  const double ground = -standing_height(robot);
  const double centre = robot.centre_of_gravity_base[0];
  const double height = robot.centre_of_gravity_base[2] - ground;
  double front = 0, rear = 0;
  for (const Eigen::Vector3d& point : ground_points(robot)) {
    const double reach = point.x() - centre;
    if (point.z() - ground > std::tan(kSettlingTilt) * std::abs(reach)) continue;
    front = std::max(front, reach);
    rear = std::max(rear, -reach);
  }
  return kGravity * std::min(front, rear) / std::max(height, 1e-6);
}

}  // namespace robot_control
