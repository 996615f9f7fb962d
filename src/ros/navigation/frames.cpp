#include "ros/navigation/frames.h"

#include <tf2/exceptions.h>

#include <cmath>

namespace robot_control {

Frames::Frames(ros::NodeHandle& handle) {
  const auto subscribe = [&](const char* topic, bool fixed) {
    const boost::function<void(const tf2_msgs::TFMessage&)> take = [this, fixed](const tf2_msgs::TFMessage& message) {
      receive(message, fixed);
    };
    return handle.subscribe<tf2_msgs::TFMessage, const tf2_msgs::TFMessage&>(topic, 100, take, nullptr,
                                                                             ros::TransportHints().tcpNoDelay());
  };
  moving_ = subscribe("tf", false);
  fixed_ = subscribe("tf_static", true);
}

void Frames::receive(const tf2_msgs::TFMessage& message, bool fixed) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    buffer_.setTransform(transform, "tf", fixed);
  }
}

std::optional<FoundPose> Frames::lookup(const std::string& target, const std::string& source, ros::Time time,
                                        std::string& problem) const {
  try {
    const geometry_msgs::TransformStamped found = buffer_.lookupTransform(target, source, time);
    const auto& [x, y, z, w] = std::tie(found.transform.rotation.x, found.transform.rotation.y,
                                        found.transform.rotation.z, found.transform.rotation.w);
    const double yaw = std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
    return FoundPose{{found.transform.translation.x, found.transform.translation.y, yaw},
                     w * w - x * x - y * y + z * z < 0,
                     found.header.stamp.toSec()};
  } catch (const tf2::TransformException& error) {
    problem = error.what();
    return std::nullopt;
  }
}

std::optional<double> yaw_of(double x, double y, double z, double w) {
  const double length = x * x + y * y + z * z + w * w;
  if (!(std::abs(length - 1) < 0.01)) return std::nullopt;
  return std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
}

}  // namespace robot_control
