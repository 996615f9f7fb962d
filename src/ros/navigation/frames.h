#pragma once
/// Poses in a plane from the topics tf and tf_static of the robot's namespace.

#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "navigation/grid.h"
#include "ros/navigation/bounded_inputs.h"

namespace robot_control::navigation {

struct FoundPose {
  PlanarPose pose;
  bool upside_down = false;  ///< its z axis points down: angles in it run the other way
  double stamp = 0;          ///< s; 0: the two frames are fixed to each other
};

class Frames {
 public:
  explicit Frames(ros::NodeHandle& handle);

  /// Returns the pose of `source` in `target` at `time`, zero: the newest; nothing, with the reason in `problem`, where
  /// tf does not have it. Any thread may call it.
  std::optional<FoundPose> lookup(const std::string& target, const std::string& source, ros::Time time,
                                  std::string& problem) const;

 private:
  tf2::BufferCore buffer_;
  void receive(const tf2_msgs::TFMessage& message, bool fixed);

  InputTopic<BoundedTFMessage> moving_{"tf", 100};
  InputTopic<BoundedTFMessage> fixed_{"tf_static", 100};
};

}  // namespace robot_control::navigation
