#include "ros/navigation/localization_node.h"

#include <geometry_msgs/PoseArray.h>
#include <std_srvs/Empty.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "navigation/map_file.h"
#include "ros/navigation/map_service.h"
#include "ros/navigation/map_topics.h"
#include "ros/navigation/navigation_messages.h"
#include "ros/navigation/scan_input.h"
#include "ros/nodes/service_node.h"

namespace robot_control::navigation {
namespace {

constexpr std::uint32_t kSeed = 1;    // the same scans give the same particles
constexpr double kCloudPeriod = 1;    // s
constexpr std::size_t kShown = 2000;  // particles of particlecloud

/// Deviations at localization.initial_pose: a robot that is set down by hand on a mark.
const Eigen::Vector3d kByHand(0.2, 0.2, 0.1);  // m, m, rad

class LocalizationService {
 public:
  explicit LocalizationService(const Parameters& parameters) {
    const LocalizationParameters& given = parameters.localization;
    if (!given.map.empty()) load(given.map);
    if (given.initial_pose) begin_at(*given.initial_pose);
    initial_.connect(handle_,
                     [this](const geometry_msgs::PoseWithCovarianceStamped& message) { receive_pose(message); });
    pose_ = handle_.advertise<geometry_msgs::PoseWithCovarianceStamped>("amcl_pose", 2, true);
    cloud_ = handle_.advertise<geometry_msgs::PoseArray>("particlecloud", 1, true);
    global_ = handle_.advertiseService("global_localization", &LocalizationService::search, this);
    timer_ = handle_.createWallTimer(ros::WallDuration(kCloudPeriod),
                                     [this](const ros::WallTimerEvent&) { publish_cloud(); });
  }

  static std::vector<std::string> missing() { return {}; }
  void diagnose(DiagnosticReport& report) const { topics_.diagnose(report); }

 private:
  std::string load(const std::string& path) {
    const Grid map = read_map(path);
    localizer_ = std::make_unique<Localizer>(map, kSeed);
    topics_.publish(map);
    return "loaded " + path + ": " + std::to_string(map.columns) + " x " + std::to_string(map.rows) +
           " cells; set a pose (initialpose) or call global_localization";
  }

  void begin_at(const NumberList<3>& pose) {
    if (!localizer_) throw std::invalid_argument("localization.initial_pose needs a map: also set localization.map");
    localizer_->set_pose({{pose[0], pose[1], pose[2]}, kByHand.cwiseProduct(kByHand).asDiagonal()});
  }

  void receive_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
    const auto pose = given_pose(message);
    if (!pose) return;
    if (!localizer_) {
      ROS_WARN("initialpose is refused: there is no map yet (load_map)");
      return;
    }
    localizer_->set_pose(*pose);
  }

  bool search(std_srvs::Empty::Request& /*request*/, std_srvs::Empty::Response& /*response*/) {
    if (!localizer_) return false;
    localizer_->search();
    return true;
  }

  void use(const PlacedScan& scan) {
    stamp_ = scan.stamp;
    if (localizer_ && localizer_->update(scan.scan, scan.laser, scan.odometry)) publish_pose();
  }

  void receive_odometry(const nav_msgs::Odometry& odometry) {
    const std::string scan = input_.problem();
    if (!localizer_)
      return topics_.publish("no pose", "there is no map: set localization.map or call load_map", 0, stamp_);
    const bool localized = localizer_->state() == Localization::kLocalized;
    const bool lacks_scan = !scan.empty() && (localized || localizer_->awaits_scan());
    const std::string why = lacks_scan ? scan : localizer_->reason();
    topics_.publish(name_of(localizer_->state()), why, localizer_->explained(), stamp_);
    if (localized) topics_.publish(localizer_->correction(), odometry);
  }

  void publish_pose() {
    geometry_msgs::PoseWithCovarianceStamped message;
    message.header.frame_id = kMapFrame;
    message.header.stamp = stamp_;
    message.pose = covariance_message(localizer_->pose());
    pose_.publish(message);
  }

  void publish_cloud() {
    if (!localizer_ || cloud_.getNumSubscribers() == 0) return;
    const std::vector<PlanarPose> particles = localizer_->particles();
    geometry_msgs::PoseArray message;
    message.header.frame_id = kMapFrame;
    message.header.stamp = stamp_;
    const std::size_t step = std::max<std::size_t>(1, particles.size() / kShown);
    for (std::size_t i = 0; i < particles.size(); i += step) message.poses.push_back(pose_message(particles[i]));
    cloud_.publish(message);
  }

  ros::NodeHandle handle_;
  std::unique_ptr<Localizer> localizer_;  // null: there is no map
  ros::Time stamp_;
  MapTopics topics_{handle_};
  ScanInput input_{handle_, "scan", [this](const PlacedScan& scan) { use(scan); },
                   [this](const nav_msgs::Odometry& odometry) { receive_odometry(odometry); }};
  ros::ServiceServer load_ = map_service(handle_, "load_map", [this](const std::string& path) { return load(path); });
  InputTopic<BoundedPoseWithCovarianceStamped> initial_{"initialpose", 1};
  ros::Publisher pose_, cloud_;
  ros::ServiceServer global_;
  ros::WallTimer timer_;
};

}  // namespace

std::unique_ptr<Node> make_localization(const Setup& setup) {
  return std::make_unique<ServiceNode<LocalizationService>>(setup);
}

}  // namespace robot_control::navigation
