#include "ros/navigation/collision_guard_node.h"

#include <robot_control/GuardState.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <stdexcept>

#include "navigation/driven/driven_robot.h"
#include "navigation/guard/collision_guard.h"
#include "navigation/guard/moving_outline.h"
#include "ros/navigation/navigation_messages.h"
#include "ros/navigation/scan_input.h"
#include "ros/nodes/service_node.h"
#include "ros/reports/diagnostics.h"
#include "ros/startup/description.h"
#include "signals/formatted_text.h"

namespace robot_control::navigation {
namespace {

constexpr double kWatchPeriod = 0.1;     // s
constexpr double kReportedWay = 0.3;     // m; with less, the state says why
constexpr double kRequestTimeout = 0.5;  // s without a message after which nothing is requested

/// The outline of the robot, by `robot_description` and, with legs or an arm, `joint_states`.
class RobotOutline {
 public:
  RobotOutline(ros::NodeHandle& handle, const Parameters& parameters)
      : outline_(read_rigid_bodies(published_description()),
                 driven_robot(published_description(), parameters).outline) {
    if (outline_.changes())
      joints_.connect(handle, [this](const sensor_msgs::JointState& message) { receive(message); });
  }
  const Footprint& footprint() const noexcept { return outline_.footprint(); }

 private:
  void receive(const sensor_msgs::JointState& message) {
    std::map<std::string, double> positions;
    for (std::size_t i = 0; i < std::min(message.name.size(), message.position.size()); ++i) {
      if (std::isfinite(message.position[i])) positions[message.name[i]] = message.position[i];
    }
    try {
      outline_.update(positions, ros::SteadyTime::now().toSec());
    } catch (const std::invalid_argument& error) {  // the base lies beside such an outline
      ROS_WARN_THROTTLE(10, "joint_states: %s", error.what());
    }
  }

  MovingOutline outline_;
  InputTopic<BoundedJointState> joints_{"joint_states", 1};
};

class CollisionGuardService {
 public:
  explicit CollisionGuardService(const Parameters& parameters)
      : active_(parameters.collision_guard.guard != GuardMode::kOff), outline_(handle_, parameters) {
    if (!active_) {
      publish({.clearance = std::numeric_limits<double>::infinity(), .problem = {}, .obstacle = {}});
      return;
    }
    for (const std::string& topic : parameters.collision_guard.scans) {
      const bool first = inputs_.empty();
      inputs_.push_back(std::make_unique<ScanInput>(
          handle_, topic, [this, topic](const PlacedScan& scan) { insert(topic, scan); },
          [this, first](const nav_msgs::Odometry& odometry) {
            if (first) check(odometry);
          }));
    }
    requested_.connect(handle_, [this](const geometry_msgs::TwistStamped& message) {
      request_ = motion_of(message.twist), requested_at_ = now();
    });
    timer_ = handle_.createWallTimer(ros::WallDuration(kWatchPeriod), [this](const ros::WallTimerEvent&) { watch(); });
  }

  static std::vector<std::string> missing() { return missing_description(); }

  void diagnose(DiagnosticReport& report) const {
    if (!active_) return report.ok("off");
    if (verdict_.problem.empty()) {
      report.ok("the lasers are trusted");
    } else {
      report.warn(verdict_.problem);
    }
    report.value("clearance_m", verdict_.clearance);
  }

 private:
  static double now() { return ros::SteadyTime::now().toSec(); }

  void insert(const std::string& laser, const PlacedScan& scan) {
    guard_.set_footprint(outline_.footprint());
    guard_.insert(laser, scan.scan, scan.laser, scan.odometry.mean, scan.stamp.toSec());
  }

  void check(const nav_msgs::Odometry& odometry) {
    if (!input_problem_.empty()) return;
    const PlanarMotion measured = motion_of(odometry.twist.twist);
    const bool requests = now() - requested_at_ < kRequestTimeout;
    const ros::Time time = ros::Time::now();
    header_ = odometry.header;
    header_.frame_id = odometry.child_frame_id;
    GuardVerdict verdict =
        guard_.check(planar_of(odometry.pose.pose), measured, requests ? request_ : PlanarMotion(), time.toSec());
    const double age = std::clamp((time - odometry.header.stamp).toSec(), 0.0, kScanTimeout);
    verdict.clearance = std::max(0.0, verdict.clearance - std::hypot(measured.linear, measured.lateral) * age);
    publish(verdict);
  }

  void watch() {
    input_problem_ = inputs_.empty() ? "collision_guard.scans is empty: name the topics of the lasers" : "";
    for (const auto& input : inputs_) {
      if (input_problem_.empty()) input_problem_ = input->problem();
    }
    if (!input_problem_.empty()) publish({.clearance = 0, .problem = input_problem_, .obstacle = {}});
  }

  void publish(const GuardVerdict& verdict) {
    verdict_ = verdict;
    std_msgs::Float64 clearance;
    clearance.data = verdict.clearance;
    clearance_.publish(clearance);
    GuardState state;
    state.header = header_;
    state.clearance = verdict.clearance;
    state.trusted = verdict.problem.empty();
    state.reason = verdict.problem;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    state.obstacle.x = verdict.obstacle ? verdict.obstacle->x : kNone;
    state.obstacle.y = verdict.obstacle ? verdict.obstacle->y : kNone;
    if (verdict.obstacle && verdict.clearance < kReportedWay)
      state.reason = formatted("the laser sees an obstacle %.2f m from the robot",
                               std::max(0.0, guard_.footprint().distance(*verdict.obstacle)));
    state_.publish(state);
  }

  ros::NodeHandle handle_;
  const bool active_;
  RobotOutline outline_;
  CollisionGuard guard_{outline_.footprint()};
  std::vector<std::unique_ptr<ScanInput>> inputs_;
  InputTopic<BoundedTwistStamped> requested_{"cmd_vel_requested", 1};
  ros::Publisher clearance_ = handle_.advertise<std_msgs::Float64>("clearance", 1, true);
  ros::Publisher state_ = handle_.advertise<GuardState>("guard_state", 1, true);
  ros::WallTimer timer_;
  PlanarMotion request_;
  double requested_at_ = -1e9;  // s
  std::string input_problem_ = "no scan received: start the driver of the laser";
  std_msgs::Header header_;
  GuardVerdict verdict_;
};

}  // namespace

std::unique_ptr<Node> make_collision_guard(const Setup& setup) {
  return std::make_unique<ServiceNode<CollisionGuardService>>(setup);
}

}  // namespace robot_control::navigation
