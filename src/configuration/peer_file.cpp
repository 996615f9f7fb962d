#include "configuration/peer_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>

#include "configuration/parameters.h"

namespace robot_control {
namespace {

struct PeerKey {
  std::string_view peer_name;
  std::string_view own_path;  ///< empty: this package needs no such key
};

constexpr auto kPeerKeys = std::to_array<PeerKey>({
    {"left_wheel", "robot.left_wheel_joints"},
    {"right_wheel", "robot.right_wheel_joints"},
    {"left_wheel_names", "robot.left_wheel_joints"},
    {"right_wheel_names", "robot.right_wheel_joints"},
    {"wheel_separation", "robot.wheel_separation"},
    {"wheel_radius", "robot.wheel_radius"},
    {"wheel_separation_multiplier", "robot.wheel_separation_multiplier"},
    {"wheel_radius_multiplier", "robot.wheel_radius, multiplied by it"},
    {"left_wheel_radius_multiplier", "robot.left_wheel_radius_multiplier"},
    {"right_wheel_radius_multiplier", "robot.right_wheel_radius_multiplier"},
    {"wheels_per_side", ""},
    {"linear", "max_linear_speed, max_linear_acceleration, max_linear_deceleration, max_linear_jerk"},
    {"angular", "max_angular_speed, max_angular_acceleration, max_angular_deceleration, max_angular_jerk"},
    {"linear.x.max_velocity", "max_linear_speed"},
    {"linear.x.min_velocity", "min_linear_speed"},
    {"linear.x.max_acceleration", "max_linear_acceleration"},
    {"linear.x.min_acceleration", "max_linear_deceleration"},
    {"linear.x.max_deceleration", "max_linear_deceleration"},
    {"linear.x.max_acceleration_reverse", "max_linear_acceleration_reverse"},
    {"linear.x.max_deceleration_reverse", "max_linear_deceleration_reverse"},
    {"linear.x.max_jerk", "max_linear_jerk"},
    {"linear.x.min_jerk", "max_linear_jerk"},
    {"linear.x.has_jerk_limits", "max_linear_jerk, where 0 is off"},
    {"angular.z.max_velocity", "max_angular_speed"},
    {"angular.z.min_velocity", "max_angular_speed"},
    {"angular.z.max_acceleration", "max_angular_acceleration"},
    {"angular.z.min_acceleration", "max_angular_deceleration"},
    {"angular.z.max_deceleration", "max_angular_deceleration"},
    {"angular.z.max_acceleration_reverse", "max_angular_acceleration"},
    {"angular.z.max_deceleration_reverse", "max_angular_deceleration"},
    {"angular.z.max_jerk", "max_angular_jerk"},
    {"angular.z.min_jerk", "max_angular_jerk"},
    {"angular.z.has_jerk_limits", "max_angular_jerk, where 0 is off"},
    {"max_velocity", "max_linear_speed or max_angular_speed"},
    {"min_velocity", "min_linear_speed or max_angular_speed"},
    {"max_acceleration", "max_linear_acceleration or max_angular_acceleration"},
    {"min_acceleration", "max_linear_deceleration or max_angular_deceleration"},
    {"max_deceleration", "max_linear_deceleration or max_angular_deceleration"},
    {"max_jerk", "max_linear_jerk or max_angular_jerk"},
    {"min_jerk", "max_linear_jerk or max_angular_jerk"},
    {"has_velocity_limits", ""},
    {"has_acceleration_limits", ""},
    {"has_jerk_limits", "max_linear_jerk and max_angular_jerk, where 0 is off"},
    {"use_stamped_vel", ""},
    {"allow_multiple_cmd_vel_publishers", "one_sender"},
    {"preserve_turning_radius", "keep_curvature"},
    {"publish_rate", "command_rate, {estimator}.odom_rate, {estimator}.joint_states_rate"},
    {"publish_cmd", ""},
    {"publish_limited_velocity", ""},
    {"publish_wheel_joint_controller_state", ""},
    {"publish_joint_trajectory_controller_state", ""},
    {"open_loop", ""},
    {"position_feedback", ""},
    {"enable_odom_tf", "{estimator}.publish_tf"},
    {"odom_frame_id", "{estimator}.odom_frame"},
    {"base_frame_id", "{estimator}.base_frame"},
    {"pose_covariance_diagonal", "{estimator}.pose_covariance_diagonal"},
    {"twist_covariance_diagonal", "{estimator}.twist_covariance_diagonal"},
    {"velocity_rolling_window_size", "{estimator}.speed_bandwidth"},
});

/// Returns the evidence that no file of this package has.
std::string sign_in(const YAML::Node& node, bool foreign, int depth) {
  constexpr int kMaxDepth = 6;  // bounds a map that contains itself by an alias
  if (!node.IsMap() || depth > kMaxDepth) return "";
  for (const auto& pair : node) {
    if (!pair.first.IsScalar()) continue;
    const std::string& key = pair.first.Scalar();
    const bool text = pair.second.IsScalar();
    if (key == "ros__parameters") return key;
    if (key == "type" && text && pair.second.Scalar().ends_with("Controller")) return "type " + pair.second.Scalar();
    constexpr auto kForeignKeys = std::to_array<std::string_view>(
        {"left_wheel", "left_wheel_names", "has_velocity_limits", "wheel_radius_multiplier", "enable_odom_tf"});
    if (foreign && std::ranges::find(kForeignKeys, key) != kForeignKeys.end()) return key;
    std::string inner = sign_in(pair.second, foreign, depth + 1);
    if (!inner.empty()) return inner;
  }
  return "";
}

}  // namespace

std::optional<Problem> peer_problem(const std::string& path, const YAML::Node& root) {
  if (!root.IsMap()) return {};
  Parameters own;
  const std::vector<Block> blocks = schema(own).blocks;
  for (const auto& pair : root) {
    if (!pair.first.IsScalar()) continue;
    const std::string& name = pair.first.Scalar();
    YAML::Node alone;
    alone[name] = pair.second;
    const bool foreign = std::ranges::find(blocks, name, &Block::name) == blocks.end();
    const std::string sign = sign_in(alone, foreign, 0);
    if (sign.empty()) continue;
    const std::string line = ", line " + std::to_string(pair.first.Mark().line + 1);
    const std::string evidence = (sign.starts_with(name) ? "" : printable(name) + " with ") + printable(sign) + line;
    return Problem{path, "", "is a configuration of ros_controllers, not of robot_control (" + evidence + ")", "",
                   kPeerTable};
  }
  return {};
}

std::string suggest_for_peer_key(std::string_view name) {
  const auto found = std::ranges::find(kPeerKeys, name, &PeerKey::peer_name);
  if (found == kPeerKeys.end()) return "";
  const std::string here = found->own_path.empty() ? "needs no key here" : "here " + std::string(found->own_path);
  return "a key of ros_controllers, " + with_programs(here, {}) + "; " + kPeerTable;
}

}  // namespace robot_control
