#pragma once
/// These are the messages that the programs of navigation receive, with possible lengths (bounded_message.h).

#include <dynamic_reconfigure/Config.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Odometry.h>
#include <robot_control/FollowPathActionFeedback.h>
#include <robot_control/FollowPathActionResult.h>
#include <robot_control/GuardState.h>
#include <robot_control/LocalizationState.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_msgs/TFMessage.h>

#include "navigation/grid.h"
#include "ros/inputs/input_topic.h"
#include "ros/network/wire_guard.h"

namespace robot_control::navigation {

using BoundedLaserScan = Bounded<sensor_msgs::LaserScan, 52, kMaxMessage>;
using BoundedJointState = Bounded<sensor_msgs::JointState, 32, kMaxMessage>;
using BoundedGuardState = Bounded<GuardState, 57, kMaxMessage>;
using BoundedOdometry = Bounded<nav_msgs::Odometry, 700, 700 + 2 * kMaxFrameId>;
using BoundedTFMessage = Bounded<tf2_msgs::TFMessage, 4, kMaxMessage>;
using BoundedOccupancyGrid = Bounded<nav_msgs::OccupancyGrid, 96, 96 + kMaxFrameId + kMaxCells>;
using BoundedConfig = Bounded<dynamic_reconfigure::Config, 20, kMaxMessage>;
using BoundedLocalizationState = Bounded<LocalizationState, 32, kMaxMessage>;
using BoundedPoseWithCovarianceStamped = Bounded<geometry_msgs::PoseWithCovarianceStamped, 360, 360 + kMaxFrameId>;
using BoundedPoseStamped = Bounded<geometry_msgs::PoseStamped, 72, 72 + kMaxFrameId>;
using BoundedFollowPathActionFeedback = Bounded<FollowPathActionFeedback, 33, kMaxMessage>;
using BoundedFollowPathActionResult = Bounded<FollowPathActionResult, 33, kMaxMessage>;

}  // namespace robot_control::navigation
