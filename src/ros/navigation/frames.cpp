#include "ros/navigation/frames.h"

#include <tf2/exceptions.h>

#include <cmath>
#include <tuple>

#include "files/ascii.h"
#include "ros/navigation/navigation_messages.h"

namespace robot_control::navigation {

Frames::Frames(ros::NodeHandle& handle) {
  moving_.connect(handle, [this](const tf2_msgs::TFMessage& message) { receive(message, false); });
  fixed_.connect(handle, [this](const tf2_msgs::TFMessage& message) { receive(message, true); });
}

void Frames::receive(const tf2_msgs::TFMessage& message, bool fixed) {
  for (const geometry_msgs::TransformStamped& found : message.transforms) {
    const auto& [x, y, z] =
        std::tie(found.transform.translation.x, found.transform.translation.y, found.transform.translation.z);
    if (std::isfinite(x + y + z + yaw_of(found.transform.rotation))) {
      buffer_.setTransform(found, "tf", fixed);
    } else {
      ROS_WARN_THROTTLE(10,
                        "a transform to %s is refused: it is not finite, or its rotation does not have the length 1",
                        ascii(found.child_frame_id).c_str());
    }
  }
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
