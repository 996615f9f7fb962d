#pragma once
/// This file declares the messages of a simulated machine's services: std_srvs/SetBool, robot_control/Step and
/// robot_control/InjectFault. Their own headers (SetBool.h …) cannot be included in C++20 (messages.h).

#include <robot_control/InjectFaultRequest.h>
#include <robot_control/InjectFaultResponse.h>
#include <robot_control/StepRequest.h>
#include <robot_control/StepResponse.h>
#include <std_srvs/SetBoolRequest.h>
#include <std_srvs/SetBoolResponse.h>

#include "ros/messages/messages.h"

namespace robot_control {
namespace msg {

using InjectFaultRequest = robot_control::InjectFaultRequest_<Allocator>;
using InjectFaultResponse = robot_control::InjectFaultResponse_<Allocator>;
using SetBoolRequest = std_srvs::SetBoolRequest_<Allocator>;
using SetBoolResponse = std_srvs::SetBoolResponse_<Allocator>;
using StepRequest = robot_control::StepRequest_<Allocator>;
using StepResponse = robot_control::StepResponse_<Allocator>;

}  // namespace msg

inline constexpr Service kSetBoolService{"std_srvs/SetBool", "09fb03525b03e7ea1fd3992bafd87e16"};
template <>
inline constexpr Service kServiceOf<msg::SetBoolRequest> = kSetBoolService;
template <>
inline constexpr Service kServiceOf<msg::SetBoolResponse> = kSetBoolService;

inline constexpr Service kStepService{"robot_control/Step", "3090d83495cd3fc8bac35f7f11c9c6e6"};
template <>
inline constexpr Service kServiceOf<msg::StepRequest> = kStepService;
template <>
inline constexpr Service kServiceOf<msg::StepResponse> = kStepService;

inline constexpr Service kInjectFaultService{"robot_control/InjectFault", "78a16974459488140ef4bf90a6dea782"};
template <>
inline constexpr Service kServiceOf<msg::InjectFaultRequest> = kInjectFaultService;
template <>
inline constexpr Service kServiceOf<msg::InjectFaultResponse> = kInjectFaultService;

}  // namespace robot_control
