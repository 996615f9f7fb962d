#pragma once
/// The messages of dynamic_reconfigure, in the form of messages.h.

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/ReconfigureRequest.h>
#include <dynamic_reconfigure/ReconfigureResponse.h>

#include "bridge/messages/messages.h"
#include "bridge/messages/service_text.h"

namespace robot_control {
namespace msg {

using Config = dynamic_reconfigure::Config_<Allocator>;
using ConfigDescription = dynamic_reconfigure::ConfigDescription_<Allocator>;
using ConfigGroup = dynamic_reconfigure::Group_<Allocator>;
using ConfigGroupState = dynamic_reconfigure::GroupState_<Allocator>;
using ConfigParameter = dynamic_reconfigure::ParamDescription_<Allocator>;
using ConfigBool = dynamic_reconfigure::BoolParameter_<Allocator>;
using ConfigDouble = dynamic_reconfigure::DoubleParameter_<Allocator>;
using ReconfigureRequest = dynamic_reconfigure::ReconfigureRequest_<Allocator>;
using ReconfigureResponse = dynamic_reconfigure::ReconfigureResponse_<Allocator>;

}  // namespace msg

struct ReconfigureHash {
  static constexpr const char* kText = "bb125d226a21982a4a98760418dc2672";
};
struct ReconfigureName {
  static constexpr const char* kText = "dynamic_reconfigure/Reconfigure";
};

}  // namespace robot_control

namespace ros::service_traits {

template <>
struct MD5Sum<robot_control::msg::ReconfigureRequest> : robot_control::ServiceText<robot_control::ReconfigureHash> {};
template <>
struct MD5Sum<robot_control::msg::ReconfigureResponse> : robot_control::ServiceText<robot_control::ReconfigureHash> {};
template <>
struct DataType<robot_control::msg::ReconfigureRequest> : robot_control::ServiceText<robot_control::ReconfigureName> {};
template <>
struct DataType<robot_control::msg::ReconfigureResponse> : robot_control::ServiceText<robot_control::ReconfigureName> {
};

}  // namespace ros::service_traits
