#pragma once
/// Hash and type of a service, in the two forms in which roscpp reads them from its request and its response. The
/// generated service headers that contain them cannot be included in C++20, see messages.h.

#include <ros/service_traits.h>

namespace robot_control {

/// `hash`: `rossrv md5 SERVICE`, of what stands in the .srv file, comments aside.
struct Service {
  const char* type = nullptr;
  const char* hash = nullptr;
};

/// The service of which `Message` is request or response. Specialised beside the messages.
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
