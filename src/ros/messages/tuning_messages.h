#pragma once
/// This file declares the messages of the service robot_control/SetParameters.

#include <robot_control/SetParametersRequest.h>
#include <robot_control/SetParametersResponse.h>

#include "ros/messages/messages.h"

namespace robot_control {
namespace msg {

using SetParametersRequest = robot_control::SetParametersRequest_<Allocator>;
using SetParametersResponse = robot_control::SetParametersResponse_<Allocator>;

}  // namespace msg

inline constexpr Service kSetParametersService{"robot_control/SetParameters", "fb20f4f9579bda4dedf6d9fa157aa8fd"};
template <>
inline constexpr Service kServiceOf<msg::SetParametersRequest> = kSetParametersService;
template <>
inline constexpr Service kServiceOf<msg::SetParametersResponse> = kSetParametersService;

}  // namespace robot_control
