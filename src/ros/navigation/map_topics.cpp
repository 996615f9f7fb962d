#include "ros/navigation/map_topics.h"

#include <tf2_msgs/TFMessage.h>

#include "ros/navigation/navigation_messages.h"

namespace robot_control::navigation {

MapTopics::MapTopics(ros::NodeHandle& handle)
    : map_(handle.advertise<nav_msgs::OccupancyGrid>("map", 1, true)),
      metadata_(handle.advertise<nav_msgs::MapMetaData>("map_metadata", 1, true)),
      tf_(handle.advertise<tf2_msgs::TFMessage>("tf", 100)),
      state_(handle.advertise<robot_control::LocalizationState>("localization_state", 1, true)),
      static_map_(handle.advertiseService("static_map", &MapTopics::answer, this)) {}

void MapTopics::publish(const Grid& grid) {
  newest_ = grid_message(grid, kMapFrame);
  map_.publish(newest_);
  metadata_.publish(newest_.info);
}

void MapTopics::publish(const PlanarPose& correction, const nav_msgs::Odometry& odometry) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = kMapFrame;
  transform.header.stamp = odometry.header.stamp;
  transform.child_frame_id = odometry.header.frame_id;
  const geometry_msgs::Pose pose = pose_message(correction);
  transform.transform.translation.x = pose.position.x;
  transform.transform.translation.y = pose.position.y;
  transform.transform.rotation = pose.orientation;
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  tf_.publish(message);
}

void MapTopics::publish(const std::string& state, const std::string& reason, double explained, ros::Time stamp) {
  if (state == last_.state && reason == last_.reason) return;
  // A reason holds figures, which change while it stays the same.
  if (state != last_.state || reason.empty() != last_.reason.empty())
    ROS_LOG(reason.empty() ? ros::console::levels::Info : ros::console::levels::Warn, ROSCONSOLE_DEFAULT_NAME, "%s%s%s",
            state.c_str(), reason.empty() ? "" : ": ", reason.c_str());
  last_.header.frame_id = kMapFrame;
  last_.header.stamp = stamp;
  last_.state = state;
  last_.reason = reason;
  last_.explained = explained;
  state_.publish(last_);
}

void MapTopics::diagnose(DiagnosticReport& report) const {
  if (last_.state.empty()) return report.warn("no odom received: start the robot");
  if (last_.reason.empty()) {
    report.ok(last_.state);
  } else {
    report.warn(last_.state + ": " + last_.reason);
  }
  report.value("state", last_.state);
  report.value("explained", last_.explained);
}

bool MapTopics::answer(nav_msgs::GetMap::Request& /*request*/, nav_msgs::GetMap::Response& response) {
  response.map = newest_;
  return !newest_.data.empty();
}

}  // namespace robot_control::navigation
