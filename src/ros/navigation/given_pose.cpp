#include "ros/navigation/given_pose.h"

#include <cmath>

#include "ros/navigation/frames.h"
#include "ros/navigation/map_topics.h"

namespace robot_control {
UncertainPose planar_part(const geometry_msgs::PoseWithCovariance& given) {
  const auto& q = given.pose.orientation;
  UncertainPose result;
  result.mean = {given.pose.position.x, given.pose.position.y, yaw_of(q.x, q.y, q.z, q.w).value_or(NAN)};
  constexpr int kOf[3] = {0, 1, 5};  // x, y, yaw among x y z roll pitch yaw
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      result.covariance(row, column) = given.covariance[static_cast<std::size_t>(6 * kOf[row] + kOf[column])];
  return result;
}

bool is_finite(const UncertainPose& pose) {
  return std::isfinite(pose.mean.x + pose.mean.y + pose.mean.yaw) && pose.covariance.allFinite();
}

GivenPose given_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
  GivenPose given{planar_part(message.pose), ""};
  if (message.header.frame_id != kMapFrame) {
    given.problem = "initialpose is refused: its frame is '" + message.header.frame_id + "', it must be 'map'";
  } else if (!is_finite(given.pose)) {
    given.problem = "initialpose is refused: it is not finite, or its orientation has not the length 1";
  } else if (std::hypot(given.pose.mean.x, given.pose.mean.y) > 1e6) {
    given.problem = "initialpose is refused: it lies beyond 1000 km";
  }
  return given;
}

}  // namespace robot_control
