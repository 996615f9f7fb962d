#pragma once
/// This file declares the messages of the service robot_control/SetOdometry.

#include <robot_control/SetOdometryRequest.h>
#include <robot_control/SetOdometryResponse.h>

#include "ros/messages/messages.h"

namespace robot_control {
namespace msg {

using SetOdometryRequest = robot_control::SetOdometryRequest_<Allocator>;
using SetOdometryResponse = robot_control::SetOdometryResponse_<Allocator>;

}  // namespace msg

inline constexpr Service kSetOdometryService{"robot_control/SetOdometry", "993be43043f8c46d74f4095fc4c7090d"};
template <>
inline constexpr Service kServiceOf<msg::SetOdometryRequest> = kSetOdometryService;
template <>
inline constexpr Service kServiceOf<msg::SetOdometryResponse> = kSetOdometryService;

}  // namespace robot_control
