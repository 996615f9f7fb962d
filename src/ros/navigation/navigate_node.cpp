#include "ros/navigation/navigate_node.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <nav_msgs/OccupancyGrid.h>
#include <robot_control/LocalizationState.h>
#include <ros/ros.h>
#include <std_srvs/Empty.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "navigation/footprint.h"
#include "navigation/map_consistency.h"
#include "navigation/map_file.h"
#include "navigation/text.h"
#include "ros/navigation/goal_servers.h"
#include "ros/navigation/navigation_messages.h"
#include "ros/navigation/own_parameter.h"
#include "ros/navigation/path_client.h"
#include "ros/navigation/scan_guard.h"

namespace robot_control::navigation {
namespace {

constexpr double kPeriod = 0.1;      // s
constexpr double kTfPatience = 0.3;  // s for which a scan waits for tf
constexpr double kOldPlace = 1.0;    // s; a localisation is as slow as its scans

Footprint read_footprint(ros::NodeHandle& handle) {
  std::string urdf;
  const std::string name = handle.resolveName("robot_description");
  for (bool said = false; !handle.getParam("robot_description", urdf); said = true) {
    if (!said) ROS_INFO("waiting for %s: start the robot", name.c_str());
    ros::WallDuration(0.2).sleep();
    if (!ros::ok()) throw std::runtime_error("interrupted while it waited for " + name);
  }
  return footprint_of_urdf(urdf, name);
}

class NavigateNode {
 public:
  NavigateNode()
      : footprint_(read_footprint(handle_)),
        guard_(handle_, footprint_),
        path_client_(handle_),
        servers_(
            handle_, [this](const GoalServers::Goal& goal) { begin(goal); }, [this] { cancel("cancelled"); }) {
    speed_ = own_parameter("speed", 0.5, "a number of m/s");
    unknown_is_free_ = own_parameter("unknown_is_free", false, "true or false");
    map_frame_ = own_parameter<std::string>("map_frame", "map", "the name of a frame");
    if (!(speed_ > 0 && speed_ <= 10)) throw std::runtime_error("~speed must be above 0 and at most 10 m/s");
    map_ = handle_.subscribe("map", 1, &NavigateNode::receive_map, this);
    localized_ = handle_.subscribe<LocalizationState>(
        "localization_state", 1, [this](const LocalizationState::ConstPtr& message) { localization_ = message; });
    costmap_topic_ = handle_.advertise<nav_msgs::OccupancyGrid>("costmap", 1, true);
    diagnostics_ = handle_.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1);
    clear_ = handle_.advertiseService("clear_costmaps", &NavigateNode::clear, this);
    timer_ = handle_.createWallTimer(ros::WallDuration(kPeriod), [this](const ros::WallTimerEvent&) { step(); });
    seconds_ = handle_.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) { report(); });
  }

 private:
  static double now() { return ros::SteadyTime::now().toSec(); }

  void receive_map(const nav_msgs::OccupancyGrid& message) {
    const auto& [info, data] = std::tie(message.info, message.data);
    const PlanarPose origin = planar_of(info.origin);
    std::string problem = grid_problem(info.width, info.height, info.resolution, origin.x, origin.y, origin.yaw);
    if (problem.empty() && data.size() != std::size_t{info.width} * info.height) {
      problem = "the map has " + std::to_string(data.size()) + " cells, and width x height are others";
    }
    if (problem.empty() && message.header.frame_id != map_frame_) {
      problem = "the map is in the frame '" + message.header.frame_id + "', and ~map_frame is '" + map_frame_ + "'";
    }
    if (!problem.empty()) {
      ROS_WARN("map is refused: %s", problem.c_str());
      if (!costmap_) map_problem_ = "map is refused: " + problem;
      return;
    }
    const int columns = static_cast<int>(info.width), rows = static_cast<int>(info.height);
    costmap_.reset();  // before the new one: two of the largest maps would take 0.8 GB
    costmap_ = std::make_unique<Costmap>(Grid{columns, rows, info.resolution, origin.x, origin.y, data}, footprint_,
                                         unknown_is_free_);
    consistency_ = MapConsistency();
  }

  /// Takes a scan into the costmap, and compares it with the map. A scan waits until tf knows the place at its stamp.
  void process_scan(const ros::Time& time) {
    if (!waiting_ || (time - waiting_->seen.stamp).toSec() > kTfPatience) {
      if (auto scan = guard_.next_scan()) waiting_ = std::move(scan);
    }
    if (!waiting_ || !costmap_) return;
    const PlacedScan& seen = waiting_->seen;
    const auto base = frames_.lookup(map_frame_, guard_.input().base_frame(), seen.stamp, scan_problem_);
    if (!base) return;
    costmap_->foresee(placed(waiting_->ahead, base->pose));
    consistency_.update(costmap_->insert(seen.scan, composed(base->pose, seen.laser), now()));
    waiting_.reset();
    seen_at_ = time;
  }

  /// Returns why nothing can be driven now, and sets the robot's place if it is known.
  std::string problem(const ros::Time& time) {
    if (!costmap_) return map_problem_;
    if (const std::string why = guard_.input().problem(); !why.empty()) return why;
    if (localization_ && localization_->state != "localized") {
      return "the robot is not localised: " + localization_->state + ": " + localization_->reason;
    }
    std::string why;
    const auto place = frames_.lookup(map_frame_, guard_.input().base_frame(), ros::Time(), why);
    if (!place) return "the robot is not localised: " + why;
    pose_ = place->pose;
    const double age = time.toSec() - place->stamp;
    if (place->stamp > 0 && age > kOldPlace)
      return text("the robot is not localised: tf from %s is %.1f s old", map_frame_.c_str(), age);
    if ((time - seen_at_).toSec() > kOldPlace)
      return "tf does not give the place of the scans in the map: " + scan_problem_;
    if (!consistency_.problem().empty()) return consistency_.problem();
    return path_client_.connected() ? "" : "follow_path does not run: rosrun robot_control follow_path.py";
  }

  void begin(const GoalServers::Goal& goal) {
    requested_ = ros::Time::now();
    goal_speed_ = goal.speed;
    PlanarPose target = planar_of(goal.target.pose);
    std::string why, frame = goal.target.header.frame_id;
    if (!frame.empty() && frame[0] == '/') frame.erase(0, 1);
    if (!std::isfinite(target.yaw)) return refuse("the goal's orientation is no quaternion of length 1");
    if (!(goal.speed >= 0 && goal.speed <= 10)) return refuse("the goal's speed must be from 0 to 10 m/s");
    if (frame.empty()) return refuse("the goal has no frame: set header.frame_id, for instance to " + map_frame_);
    if (frame != map_frame_) {
      const auto found = frames_.lookup(map_frame_, frame, ros::Time(), why);
      if (!found) return refuse("tf does not connect the goal's frame with the map's: " + why);
      target = composed(found->pose, target);
    }
    navigator_.begin(target, now());
  }

  void refuse(const std::string& why) { cancel(why, false); }

  void cancel(const std::string& why, bool cancelled = true) {
    if (navigator_.active()) path_client_.cancel();
    navigator_.end();
    conclude(false, cancelled, why);
  }

  void conclude(bool reached, bool cancelled, const std::string& reason) {
    ROS_INFO("%s", reason.c_str());
    last_ = reached || cancelled ? "" : reason;
    servers_.conclude(reached, cancelled, reason);
  }

  void step() {
    const ros::Time time = ros::Time::now();
    process_scan(time);
    const std::string why = problem(time);
    if (navigator_.active()) {
      const std::string slowed_by = path_client_.reason().empty() ? guard_.reason() : path_client_.reason();
      output_ = navigator_.step({now(), why, consistency_.explanation(), slowed_by, pose_, path_client_.report()},
                                costmap_.get());
      if (output_.cancel) path_client_.cancel();
      if (output_.path)
        path_client_.send(*output_.path, map_frame_, goal_speed_ > 0 ? goal_speed_ : speed_, requested_);
      if (output_.state == NavigatorState::kReached) conclude(true, false, "reached");
      if (output_.state == NavigatorState::kFailed) conclude(false, false, output_.reason);
      servers_.feedback(output_, pose_, map_frame_);
    }
    guard_.guard(navigator_.active(), path_client_.intended(pose_));
  }

  /// Publishes costmap and diagnostics, at 1 Hz.
  void report() {
    diagnostic_msgs::DiagnosticArray array;
    array.header.stamp = ros::Time::now();
    array.status.resize(1);
    auto& status = array.status[0];
    status.name = ros::this_node::getName().substr(1);
    const std::string& reason = navigator_.active() ? output_.reason : last_;
    status.level = reason.empty() ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN;
    status.message = reason.empty() ? name_of(navigator_.active() ? output_.state : NavigatorState::kIdle) : reason;
    status.values.resize(1);
    status.values[0].key = "goal";
    status.values[0].value = name_of(navigator_.active() ? output_.state
                                     : last_.empty()     ? NavigatorState::kIdle
                                                         : NavigatorState::kFailed);
    diagnostics_.publish(array);
    if (!costmap_ || costmap_topic_.getNumSubscribers() == 0) return;
    costmap_->update(now());
    Grid grid = costmap_->grid();
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const double air = costmap_->distance({column, row}) - footprint_.inscribed;
        grid.cells[grid.index({column, row})] =
            air > 0                             ? static_cast<std::int8_t>(98 * std::max(0.0, 1 - air / kFullClearance))
            : costmap_->occupied({column, row}) ? kOccupiedCell
                                                : 99;
      }
    }
    costmap_topic_.publish(grid_message(grid, map_frame_));
  }

  bool clear(std_srvs::Empty::Request& /*request*/, std_srvs::Empty::Response& /*response*/) {
    if (costmap_) costmap_->clear();
    return true;
  }

  ros::NodeHandle handle_;
  const Footprint footprint_;
  ScanGuard guard_;
  const Frames& frames_ = guard_.input().frames();
  PathClient path_client_;
  Navigator navigator_;
  std::unique_ptr<Costmap> costmap_;
  GoalServers servers_;
  ros::Subscriber map_, localized_;
  LocalizationState::ConstPtr localization_;
  ros::Publisher costmap_topic_, diagnostics_;
  ros::ServiceServer clear_;
  ros::WallTimer timer_, seconds_;

  double speed_ = 0.5, goal_speed_ = 0;  // m/s
  bool unknown_is_free_ = false;
  std::string map_frame_, map_problem_ = "no map has come: start slam, or localization with a saved map";
  std::optional<GuardedScan> waiting_;  // for tf
  ros::Time seen_at_, requested_;
  std::string scan_problem_, last_;
  MapConsistency consistency_;
  PlanarPose pose_;
  NavigatorOutput output_;
};

}  // namespace

void spin_navigate() {
  NavigateNode node;
  ros::spin();
}

}  // namespace robot_control::navigation
