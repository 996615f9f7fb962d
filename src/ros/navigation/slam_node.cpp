#include "ros/navigation/slam_node.h"

#include "navigation/mapping/saved_map.h"
#include "ros/navigation/map_service.h"
#include "ros/navigation/map_topics.h"
#include "ros/navigation/navigation_messages.h"
#include "ros/navigation/scan_input.h"
#include "ros/nodes/service_node.h"

namespace robot_control::navigation {
namespace {

constexpr double kMapPeriod = 2;  // s between two messages of a map that grows

class SlamService {
 public:
  explicit SlamService(const Parameters& parameters) {
    if (!parameters.slam.map.empty()) load(parameters.slam.map);
    initial_.connect(handle_,
                     [this](const geometry_msgs::PoseWithCovarianceStamped& message) { receive_pose(message); });
    timer_ =
        handle_.createWallTimer(ros::WallDuration(kMapPeriod), [this](const ros::WallTimerEvent&) { publish_map(); });
  }

  static std::vector<std::string> missing() { return {}; }
  void diagnose(DiagnosticReport& report) const { topics_.diagnose(report); }

 private:
  void use(const PlacedScan& scan) {
    mapper_.update(scan.scan, scan.laser, scan.odometry);
    changed_ = used_ = true;
    stamp_ = scan.stamp;
  }

  void receive_odometry(const nav_msgs::Odometry& odometry) {
    const std::string why = input_.problem();
    if (!used_) return topics_.publish("no pose", why, 0, odometry.header.stamp);
    const bool fits = mapper_.fits();
    topics_.publish(fits ? "localized" : "lost", !fits ? mapper_.reason() : why, mapper_.matched(), stamp_);
    if (fits) topics_.publish(mapper_.correction(), odometry);
  }

  void publish_map() {
    if (changed_) topics_.publish(mapper_.grid());
    changed_ = false;
  }

  std::string save(const std::string& path) {
    save_map(path, mapper_);
    return "saved " + path + ": " + std::to_string(mapper_.graph().nodes.size()) + " nodes";
  }

  std::string load(const std::string& path) {
    mapper_ = load_map(path);
    used_ = false;
    changed_ = true;
    return "goes on with " + path + ", with the robot at its origin until initialpose is set";
  }

  void receive_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
    const auto pose = given_pose(message);
    if (!pose) return;
    mapper_.set_pose(pose->mean);
    used_ = false;
  }

  ros::NodeHandle handle_;
  Mapper mapper_;
  bool changed_ = false, used_ = false;
  ros::Time stamp_;
  MapTopics topics_{handle_};
  ScanInput input_{handle_, "scan", [this](const PlacedScan& scan) { use(scan); },
                   [this](const nav_msgs::Odometry& odometry) { receive_odometry(odometry); }};
  ros::ServiceServer save_ = map_service(handle_, "save_map", [this](const std::string& path) { return save(path); });
  ros::ServiceServer load_ = map_service(handle_, "load_map", [this](const std::string& path) { return load(path); });
  InputTopic<BoundedPoseWithCovarianceStamped> initial_{"initialpose", 1};
  ros::WallTimer timer_;
};

}  // namespace

std::unique_ptr<Node> make_slam(const Setup& setup) {
  return std::make_unique<ServiceNode<SlamService>>(setup);
}

}  // namespace robot_control::navigation
