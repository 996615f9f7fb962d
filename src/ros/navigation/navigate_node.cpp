#include "ros/navigation/navigate_node.h"

#include <nav_msgs/OccupancyGrid.h>
#include <robot_control/LocalizationState.h>
#include <ros/ros.h>
#include <std_srvs/Empty.h>

#include <cmath>

#include "navigation/driven/driven_robot.h"
#include "navigation/map_consistency.h"
#include "navigation/map_file.h"
#include "ros/navigation/goal_servers.h"
#include "ros/navigation/navigation_messages.h"
#include "ros/navigation/path_client.h"
#include "ros/navigation/scan_store.h"
#include "ros/nodes/service_node.h"
#include "ros/reports/diagnostics.h"
#include "ros/startup/description.h"
#include "signals/formatted_text.h"

namespace robot_control::navigation {
namespace {

constexpr double kPeriod = 0.1;      // s
constexpr double kTfTimeout = 0.3;   // s for which a scan waits for tf
constexpr double kMaxPoseAge = 1.0;  // s; a localisation is as slow as its scans
constexpr double kMaxOdomAge = 0.3;  // s; odom comes at 50 Hz
constexpr std::size_t kMaxWaypoints = 1000;
constexpr std::uint32_t kMapOverhead = 1024;  // bytes of a message beside its cells

class NavigateService {
 public:
  explicit NavigateService(const Parameters& parameters)
      : parameters_(parameters.navigate),
        robot_(driven_robot(published_description(), parameters)),
        zones_(parameters_.zones.empty() ? Grid() : read_map(parameters_.zones)),
        scans_(handle_),
        path_client_(handle_),
        servers_(
            handle_, [this](const GoalServers::Goal& goal) { begin(goal); }, [this] { cancel("cancelled"); }) {
    allow_messages_of(kMaxCells + kMapOverhead);
    map_.connect(handle_, [this](const nav_msgs::OccupancyGrid& message) { receive_map(message); });
    localized_.connect(handle_, [this](const LocalizationState& message) { localization_ = message; });
    updates_.connect(handle_, [this](const dynamic_reconfigure::Config& message) {
      for (const auto& entry : message.doubles) set_in_force(robot_, entry.name, entry.value);
    });
    costmap_topic_ = handle_.advertise<nav_msgs::OccupancyGrid>("costmap", 1, true);
    clear_ = handle_.advertiseService("clear_costmaps", &NavigateService::clear, this);
    timer_ = handle_.createWallTimer(ros::WallDuration(kPeriod), [this](const ros::WallTimerEvent&) { step(); });
  }

  static std::vector<std::string> missing() { return missing_description(); }

  void diagnose(DiagnosticReport& report) {
    const NavigatorState state = navigator_.active() ? output_.state
                                 : last_.empty()     ? NavigatorState::kIdle
                                                     : NavigatorState::kFailed;
    const std::string& reason = navigator_.active() ? output_.reason : last_;
    if (reason.empty()) {
      report.ok(name_of(state));
    } else {
      report.warn(reason);
    }
    report.value("goal", std::string(name_of(state)));
    publish_costmap();
  }

 private:
  static double now() { return ros::SteadyTime::now().toSec(); }

  void receive_map(const nav_msgs::OccupancyGrid& message) {
    const auto& [info, data] = std::tie(message.info, message.data);
    const PlanarPose origin = planar_of(info.origin);
    std::string problem = grid_problem(info.width, info.height, info.resolution, origin.x, origin.y, origin.yaw);
    if (problem.empty() && data.size() != std::size_t{info.width} * info.height) {
      problem = "the map has " + std::to_string(data.size()) + " cells, which differs from width x height";
    }
    if (problem.empty() && message.header.frame_id != parameters_.map_frame) {
      problem = "the map is in the frame '" + message.header.frame_id + "', and navigate.map_frame is '" +
                parameters_.map_frame + "'";
    }
    if (!problem.empty()) {
      ROS_WARN("map is refused: %s", problem.c_str());
      if (!costmap_) map_problem_ = "map is refused: " + problem;
      return;
    }
    const int columns = static_cast<int>(info.width), rows = static_cast<int>(info.height);
    costmap_.reset();  // before the new one: two of the largest maps would take 0.8 GB
    use(std::make_unique<Costmap>(Grid{columns, rows, info.resolution, origin.x, origin.y, data}, robot_.outline,
                                  parameters_.unknown_is_free));
    consistency_ = MapConsistency();
  }

  void use(std::unique_ptr<Costmap> costmap) {
    costmap_ = std::move(costmap);
    costmap_->set_zones(zones_);
  }

  /// Inserts a scan into the costmap, and compares it with the map. A scan waits until tf has the pose at its stamp.
  void process_scan(const ros::Time& time) {
    if (!waiting_ || (time - waiting_->seen.stamp).toSec() > kTfTimeout) {
      if (auto scan = scans_.next_scan()) waiting_ = std::move(scan);
    }
    if (!costmap_ && scans_.odom_frame() == parameters_.map_frame) use(std::make_unique<Costmap>(robot_.outline));
    if (!waiting_ || !costmap_) return;
    const PlacedScan& seen = waiting_->seen;
    const auto base = frames_.lookup(parameters_.map_frame, scans_.input().base_frame(), seen.stamp, scan_problem_);
    if (!base) return;
    costmap_->centre_on({base->pose.x, base->pose.y}, now());
    consistency_.update(costmap_->insert(seen.scan, composed(base->pose, seen.laser), now()));
    moving_ = composed(composed(base->pose, inverse(seen.odometry.mean)), waiting_->moving);
    foresee(moving_, base->pose, *costmap_);
    waiting_.reset();
    seen_at_ = time;
  }

  /// Returns why nothing can be driven now, and sets the robot's pose if it is known.
  std::string problem(const ros::Time& time) {
    if (!costmap_) return map_problem_;
    if (const std::string why = scans_.input().problem(); !why.empty()) return why;
    if (const GuardReport guard = scans_.guard(); !guard.trusted) return guard.reason;
    if (!localization_.state.empty() && localization_.state != "localized") {
      return "the robot is not localised: " + localization_.state + ": " + localization_.reason;
    }
    std::string why;
    // Each at its own newest time: the pose follows odom also while the localisation computes.
    const std::string& map = parameters_.map_frame;
    const std::string odom = scans_.odom_frame();
    const auto correction = frames_.lookup(map, odom, ros::Time(), why);
    const auto base = frames_.lookup(odom, scans_.input().base_frame(), ros::Time(), why);
    if (!correction || !base) return "the robot is not localised: " + why;
    pose_ = composed(correction->pose, base->pose);
    const auto age = [&](const FoundPose& found) { return found.stamp > 0 ? time.toSec() - found.stamp : 0; };
    const bool old = age(*correction) > kMaxPoseAge;
    if (old || age(*base) > kMaxOdomAge) {
      return formatted("the robot is not localised: tf from %s is %.1f s old", (old ? map : odom).c_str(),
                       age(old ? *correction : *base));
    }
    if ((time - seen_at_).toSec() > kMaxPoseAge)
      return "tf has no transform from the scans to the map: " + scan_problem_;
    if (!consistency_.problem().empty()) return consistency_.problem();
    return path_client_.connected() ? ""
                                    : "follow_path does not run: start it with rosrun robot_control follow_path.py";
  }

  void begin(const GoalServers::Goal& goal) {
    requested_ = ros::Time::now();
    goal_speed_ = goal.speed;
    if (!(goal.speed >= 0 && goal.speed <= 10)) return cancel("the goal's speed must be from 0 to 10 m/s", false);
    if (goal.targets.empty() || goal.targets.size() > kMaxWaypoints)
      return cancel("the goal has " + std::to_string(goal.targets.size()) + " waypoints: send 1 to 1000", false);
    waypoints_.clear();
    for (const geometry_msgs::PoseStamped& target : goal.targets) {
      PlanarPose pose;
      if (const std::string why = place(target, pose); !why.empty())
        return cancel(numbered(why, waypoints_.size(), goal.targets.size()), false);
      waypoints_.push_back(pose);
    }
    next_ = 0;
    navigator_.begin(waypoints_[0], now());
  }

  /// Sets the pose in the map; returns why it cannot be a goal.
  std::string place(const geometry_msgs::PoseStamped& target, PlanarPose& pose) const {
    pose = planar_of(target.pose);
    std::string why, frame = target.header.frame_id;
    if (!frame.empty() && frame[0] == '/') frame.erase(0, 1);
    if (!std::isfinite(pose.yaw)) return "the goal's orientation is not a quaternion of length 1";
    if (!(std::hypot(pose.x, pose.y) <= kFarthest)) return "the goal is not finite, or beyond 1000 km";
    if (frame.empty()) return "the goal has no frame: set header.frame_id, for instance to " + parameters_.map_frame;
    if (frame == parameters_.map_frame) return "";
    const auto found = frames_.lookup(parameters_.map_frame, frame, ros::Time(), why);
    if (!found) return "tf does not connect the goal's frame with the map's: " + why;
    pose = composed(found->pose, pose);
    return "";
  }

  /// Returns a reason that names its waypoint, if there are several.
  static std::string numbered(const std::string& why, std::size_t index, std::size_t count) {
    return count == 1 ? why : formatted("waypoint %zu of %zu: ", index + 1, count) + why;
  }

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
      const GuardReport guard = scans_.guard();
      const std::string slowed_by = path_client_.reason().empty() ? guard.reason : path_client_.reason();
      heed(guard);
      output_ = navigator_.step(
          {now(), why, consistency_.explanation(), slowed_by, pose_, scans_.motion(), path_client_.report(),
           robot_.limits, moving_, goal_speed_ > 0 ? goal_speed_ : parameters_.speed},
          costmap_.get());
      if (output_.cancel) path_client_.cancel();
      if (output_.path)
        path_client_.send(*output_.path, parameters_.map_frame, output_.speed, output_.request.has_value(), requested_);
      if (output_.request) path_client_.steer(*output_.request);
      geometry_msgs::PoseStamped pose;
      pose.header.stamp = time;
      pose.header.frame_id = parameters_.map_frame;
      pose.pose = pose_message(pose_);
      if (output_.state == NavigatorState::kReached) {
        servers_.reach(pose);
        if (++next_ < waypoints_.size()) {
          navigator_.begin(waypoints_[next_], now());
        } else {
          conclude(true, false, "reached");
        }
      }
      if (output_.state == NavigatorState::kFailed)
        conclude(false, false, numbered(output_.reason, next_, waypoints_.size()));
      servers_.feedback(output_, pose);
    }
  }

  /// Marks the obstacle before which the guard holds the robot, for the next plan.
  void heed(const GuardReport& guard) {
    if (!guard.holds) held_since_ = now();
    if (costmap_ && guard.obstacle && now() - held_since_ > kReplanPeriod)
      costmap_->block(composed(pose_, std::vector{*guard.obstacle})[0], now());
  }

  void publish_costmap() {
    if (!costmap_ || costmap_topic_.getNumSubscribers() == 0) return;
    costmap_topic_.publish(grid_message(costmap_->picture(now()), parameters_.map_frame));
  }

  bool clear(std_srvs::Empty::Request& /*request*/, std_srvs::Empty::Response& /*response*/) {
    if (costmap_) costmap_->clear();
    return true;
  }

  ros::NodeHandle handle_;
  const NavigateParameters parameters_;
  DrivenRobot robot_;
  const Zones zones_;
  ScanStore scans_;
  const Frames& frames_ = scans_.input().frames();
  PathClient path_client_;
  Navigator navigator_;
  std::unique_ptr<Costmap> costmap_;
  GoalServers servers_;
  InputTopic<BoundedOccupancyGrid> map_{"map", 1};
  InputTopic<BoundedLocalizationState> localized_{"localization_state", 1};
  InputTopic<BoundedConfig> updates_{std::string(names_of_kind(kWheeledKind).controller) + "/parameter_updates", 1};
  LocalizationState localization_;  // the newest
  ros::Publisher costmap_topic_;
  ros::ServiceServer clear_;
  ros::WallTimer timer_;

  std::vector<PlanarPose> waypoints_;  // in the map, of the present goal
  std::size_t next_ = 0;               // of them
  double goal_speed_ = 0;              // m/s
  double held_since_ = 0;              // s
  std::string map_problem_ = "no map received: start slam, or localization with a saved map";
  std::optional<StoredScan> waiting_;  // for tf
  ros::Time seen_at_, requested_;
  std::string scan_problem_, last_;
  MapConsistency consistency_;
  std::vector<MovingObject> moving_;  // in the map
  PlanarPose pose_;
  NavigatorOutput output_;
};

}  // namespace

std::unique_ptr<Node> make_navigate(const Setup& setup) {
  return std::make_unique<ServiceNode<NavigateService>>(setup);
}

}  // namespace robot_control::navigation
