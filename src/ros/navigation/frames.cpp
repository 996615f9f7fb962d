#include "ros/navigation/frames.h"

#include <tf2/exceptions.h>

#include "ros/navigation/navigation_messages.h"

namespace robot_control::navigation {

Frames::Frames(ros::NodeHandle& handle) {
  const auto subscribe = [&](const char* topic, bool fixed) {
    const boost::function<void(const tf2_msgs::TFMessage&)> take = [this, fixed](const tf2_msgs::TFMessage& message) {
      for (const geometry_msgs::TransformStamped& found : message.transforms) buffer_.setTransform(found, "tf", fixed);
    };
    return handle.subscribe<tf2_msgs::TFMessage, const tf2_msgs::TFMessage&>(topic, 100, take, nullptr,
                                                                             ros::TransportHints().tcpNoDelay());
  };
  moving_ = subscribe("tf", false);
  fixed_ = subscribe("tf_static", true);
}

std::optional<FoundPose> Frames::lookup(const std::string& target, const std::string& source, ros::Time time,
                                        std::string& problem) const {
  try {
    const geometry_msgs::TransformStamped found = buffer_.lookupTransform(target, source, time);
    const auto& turn = found.transform.rotation;
    return FoundPose{{found.transform.translation.x, found.transform.translation.y, yaw_of(turn)},
                     turn.w * turn.w - turn.x * turn.x - turn.y * turn.y + turn.z * turn.z < 0,
                     found.header.stamp.toSec()};
  } catch (const tf2::TransformException& error) {
    problem = error.what();
    return std::nullopt;
  }
}

}  // namespace robot_control::navigation
