#pragma once
/// The service robot_control/SetParameters as messages.

#include <robot_control/SetParametersRequest.h>
#include <robot_control/SetParametersResponse.h>

#include "bridge/messages/messages.h"
#include "bridge/messages/service_text.h"

namespace robot_control {
namespace msg {

using SetParametersRequest = robot_control::SetParametersRequest_<Allocator>;
using SetParametersResponse = robot_control::SetParametersResponse_<Allocator>;

}  // namespace msg

struct SetParametersHash {
  static constexpr const char* kText = "fb20f4f9579bda4dedf6d9fa157aa8fd";
};
struct SetParametersName {
  static constexpr const char* kText = "robot_control/SetParameters";
};

}  // namespace robot_control

namespace ros::service_traits {

template <>
struct MD5Sum<robot_control::msg::SetParametersRequest> : robot_control::ServiceText<robot_control::SetParametersHash> {
};
template <>
struct MD5Sum<robot_control::msg::SetParametersResponse>
    : robot_control::ServiceText<robot_control::SetParametersHash> {};
template <>
struct DataType<robot_control::msg::SetParametersRequest>
    : robot_control::ServiceText<robot_control::SetParametersName> {};
template <>
struct DataType<robot_control::msg::SetParametersResponse>
    : robot_control::ServiceText<robot_control::SetParametersName> {};

}  // namespace ros::service_traits
