#pragma once
/// The services of a simulated machine as messages: std_srvs/SetBool, robot_control/Step, robot_control/InjectFault.
/// Their own headers (SetBool.h …) cannot be included in C++20, see messages.h; below is what they say.

#include <robot_control/InjectFaultRequest.h>
#include <robot_control/InjectFaultResponse.h>
#include <robot_control/StepRequest.h>
#include <robot_control/StepResponse.h>
#include <std_srvs/SetBoolRequest.h>
#include <std_srvs/SetBoolResponse.h>

#include "bridge/messages/messages.h"
#include "bridge/messages/service_text.h"

namespace robot_control {
namespace msg {

using InjectFaultRequest = robot_control::InjectFaultRequest_<Allocator>;
using InjectFaultResponse = robot_control::InjectFaultResponse_<Allocator>;
using SetBoolRequest = std_srvs::SetBoolRequest_<Allocator>;
using SetBoolResponse = std_srvs::SetBoolResponse_<Allocator>;
using StepRequest = robot_control::StepRequest_<Allocator>;
using StepResponse = robot_control::StepResponse_<Allocator>;

}  // namespace msg

struct SetBoolHash {
  static constexpr const char* kText = "09fb03525b03e7ea1fd3992bafd87e16";
};
struct SetBoolName {
  static constexpr const char* kText = "std_srvs/SetBool";
};
struct StepHash {
  static constexpr const char* kText = "3090d83495cd3fc8bac35f7f11c9c6e6";
};
struct StepName {
  static constexpr const char* kText = "robot_control/Step";
};
struct InjectFaultHash {
  static constexpr const char* kText = "78a16974459488140ef4bf90a6dea782";
};
struct InjectFaultName {
  static constexpr const char* kText = "robot_control/InjectFault";
};

}  // namespace robot_control

namespace ros::service_traits {

template <>
struct MD5Sum<robot_control::msg::SetBoolRequest> : robot_control::ServiceText<robot_control::SetBoolHash> {};
template <>
struct MD5Sum<robot_control::msg::SetBoolResponse> : robot_control::ServiceText<robot_control::SetBoolHash> {};
template <>
struct DataType<robot_control::msg::SetBoolRequest> : robot_control::ServiceText<robot_control::SetBoolName> {};
template <>
struct DataType<robot_control::msg::SetBoolResponse> : robot_control::ServiceText<robot_control::SetBoolName> {};

template <>
struct MD5Sum<robot_control::msg::StepRequest> : robot_control::ServiceText<robot_control::StepHash> {};
template <>
struct MD5Sum<robot_control::msg::StepResponse> : robot_control::ServiceText<robot_control::StepHash> {};
template <>
struct DataType<robot_control::msg::StepRequest> : robot_control::ServiceText<robot_control::StepName> {};
template <>
struct DataType<robot_control::msg::StepResponse> : robot_control::ServiceText<robot_control::StepName> {};

template <>
struct MD5Sum<robot_control::msg::InjectFaultRequest> : robot_control::ServiceText<robot_control::InjectFaultHash> {};
template <>
struct MD5Sum<robot_control::msg::InjectFaultResponse> : robot_control::ServiceText<robot_control::InjectFaultHash> {};
template <>
struct DataType<robot_control::msg::InjectFaultRequest> : robot_control::ServiceText<robot_control::InjectFaultName> {};
template <>
struct DataType<robot_control::msg::InjectFaultResponse> : robot_control::ServiceText<robot_control::InjectFaultName> {
};

}  // namespace ros::service_traits
