#pragma once
/// roscpp reads type and hash of a service from traits of its request and of its response. The generated service
/// headers define these traits, but cannot be included in C++20 (messages.h); this file defines them instead.

#include <ros/service_traits.h>

namespace robot_control {

/// `hash` is the output of `rossrv md5 SERVICE`: the checksum of the .srv file without comments.
struct Service {
  const char* type = nullptr;
  const char* hash = nullptr;
};

/// The service whose request or response `Message` is. It is specialised beside each message.
template <class Message>
inline constexpr Service kServiceOf{};

template <class Message>
concept ServiceMessage = kServiceOf<Message>
.type != nullptr;

}  // namespace robot_control

namespace ros::service_traits {

template <robot_control::ServiceMessage Message>
struct MD5Sum<Message> {
  static const char* value() { return robot_control::kServiceOf<Message>.hash; }
  static const char* value(const Message&) { return value(); }
};

template <robot_control::ServiceMessage Message>
struct DataType<Message> {
  static const char* value() { return robot_control::kServiceOf<Message>.type; }
  static const char* value(const Message&) { return value(); }
};

}  // namespace ros::service_traits
