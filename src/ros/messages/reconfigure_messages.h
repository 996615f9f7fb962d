#pragma once
/// This file declares the messages of dynamic_reconfigure in the form of messages.h.

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/ReconfigureRequest.h>
#include <dynamic_reconfigure/ReconfigureResponse.h>

#include "ros/messages/messages.h"

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

inline constexpr Service kReconfigureService{"dynamic_reconfigure/Reconfigure", "bb125d226a21982a4a98760418dc2672"};
template <>
inline constexpr Service kServiceOf<msg::ReconfigureRequest> = kReconfigureService;
template <>
inline constexpr Service kServiceOf<msg::ReconfigureResponse> = kReconfigureService;

}  // namespace robot_control
