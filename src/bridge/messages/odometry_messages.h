#pragma once
/// The service robot_control/SetOdometry as messages.

#include <robot_control/SetOdometryRequest.h>
#include <robot_control/SetOdometryResponse.h>

#include "bridge/messages/messages.h"
#include "bridge/messages/service_text.h"

namespace robot_control {
namespace msg {

using SetOdometryRequest = robot_control::SetOdometryRequest_<Allocator>;
using SetOdometryResponse = robot_control::SetOdometryResponse_<Allocator>;

}  // namespace msg

struct SetOdometryHash {
  static constexpr const char* kText = "993be43043f8c46d74f4095fc4c7090d";
};
struct SetOdometryName {
  static constexpr const char* kText = "robot_control/SetOdometry";
};

}  // namespace robot_control

namespace ros::service_traits {

template <>
struct MD5Sum<robot_control::msg::SetOdometryRequest> : robot_control::ServiceText<robot_control::SetOdometryHash> {};
template <>
struct MD5Sum<robot_control::msg::SetOdometryResponse> : robot_control::ServiceText<robot_control::SetOdometryHash> {};
template <>
struct DataType<robot_control::msg::SetOdometryRequest> : robot_control::ServiceText<robot_control::SetOdometryName> {};
template <>
struct DataType<robot_control::msg::SetOdometryResponse> : robot_control::ServiceText<robot_control::SetOdometryName> {
};

}  // namespace ros::service_traits
