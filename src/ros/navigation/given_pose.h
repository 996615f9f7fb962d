#pragma once
/// The pose of a message of `initialpose`, as RViz's tool sends it.

#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include <string>

#include "navigation/mrpt/localizer.h"

namespace robot_control {

struct GivenPose {
  UncertainPose pose;
  std::string problem;  ///< why it is refused; "": it is not
};

/// Refuses another frame than `map`, a pose that is not finite or beyond 10⁶ m, and an orientation without the
/// length 1.
GivenPose given_pose(const geometry_msgs::PoseWithCovarianceStamped& message);

/// Returns the planar part of a pose; its yaw is NaN if the orientation has not the length 1.
UncertainPose planar_part(const geometry_msgs::PoseWithCovariance& given);

bool is_finite(const UncertainPose& pose);

}  // namespace robot_control
