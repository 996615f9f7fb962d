#pragma once
/// This file declares the messages that the bridge sends and receives, in a form that C++20 accepts.
///
/// The generated headers of ROS 1 need the allocator's member `rebind`, which std::allocator lost in C++20.
/// MessageAllocator has it. Names, checksums and bytes on the wire do not depend on the allocator.
///
/// MessageAllocator also bounds the memory of a received message. Otherwise roscpp resizes an array to the length that
/// the sender wrote, up to 2³² elements, before it checks the length of the message. Beyond kMaxArray bytes the
/// allocator throws std::length_error, which roscpp catches, and the message or request is rejected.

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <nav_msgs/Odometry.h>
#include <robot_control/DriveState.h>
#include <robot_control/RobotKind.h>
#include <robot_control/SafetyStatus.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/BatteryState.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_srvs/TriggerRequest.h>
#include <std_srvs/TriggerResponse.h>
#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <memory>
#include <stdexcept>

#include "ros/messages/service_text.h"

namespace robot_control {

inline constexpr std::size_t kMaxArray = std::size_t{1} << 20;  ///< bytes

template <class T>
struct MessageAllocator : std::allocator<T> {
  using std::allocator<T>::allocator;
  T* allocate(std::size_t count) {
    if (count > kMaxArray / sizeof(T)) throw std::length_error("an array of a message is longer than 1 MiB");
    return std::allocator<T>::allocate(count);
  }
  template <class U>
  struct rebind {
    using other = MessageAllocator<U>;
  };
};

/// With this allocator strings stay std::string.
template <>
template <>
struct MessageAllocator<void>::rebind<char> {
  using other = std::allocator<char>;
};

namespace msg {

using Allocator = MessageAllocator<void>;
using BatteryState = sensor_msgs::BatteryState_<Allocator>;
using Bool = std_msgs::Bool_<Allocator>;
using Clock = rosgraph_msgs::Clock_<Allocator>;
using DiagnosticArray = diagnostic_msgs::DiagnosticArray_<Allocator>;
using DriveState = robot_control::DriveState_<Allocator>;
using DiagnosticStatus = diagnostic_msgs::DiagnosticStatus_<Allocator>;
using Empty = std_msgs::Empty_<Allocator>;
using Float64 = std_msgs::Float64_<Allocator>;
using Float64MultiArray = std_msgs::Float64MultiArray_<Allocator>;
using Imu = sensor_msgs::Imu_<Allocator>;
using LaserScan = sensor_msgs::LaserScan_<Allocator>;
using JointState = sensor_msgs::JointState_<Allocator>;
using KeyValue = diagnostic_msgs::KeyValue_<Allocator>;
using MultiArrayDimension = std_msgs::MultiArrayDimension_<Allocator>;
using Odometry = nav_msgs::Odometry_<Allocator>;
using Quaternion = geometry_msgs::Quaternion_<Allocator>;
using RobotKind = robot_control::RobotKind_<Allocator>;
using SafetyStatus = robot_control::SafetyStatus_<Allocator>;
using TFMessage = tf2_msgs::TFMessage_<Allocator>;
using TransformStamped = geometry_msgs::TransformStamped_<Allocator>;
using TriggerRequest = std_srvs::TriggerRequest_<Allocator>;
using TriggerResponse = std_srvs::TriggerResponse_<Allocator>;
using Twist = geometry_msgs::Twist_<Allocator>;
using TwistStamped = geometry_msgs::TwistStamped_<Allocator>;
using Vector3 = geometry_msgs::Vector3_<Allocator>;

}  // namespace msg

// These replace std_srvs/Trigger.h, which cannot be included (service_text.h).
inline constexpr Service kTriggerService{"std_srvs/Trigger", "937c9679a518e3a18d831e57125ea522"};
template <>
inline constexpr Service kServiceOf<msg::TriggerRequest> = kTriggerService;
template <>
inline constexpr Service kServiceOf<msg::TriggerResponse> = kTriggerService;

}  // namespace robot_control
