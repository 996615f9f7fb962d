#pragma once
/// A Bounded message is parsed only if its length on the wire is possible for its type.
///
/// roscpp parses every message that a publisher sends. If one is too short, roscpp throws and logs it, so that a broken
/// or hostile sender would fill the log. Here the length is checked first. A message out of bounds is neither copied
/// nor parsed, and `accepted` stays false. Before that, roscpp has received the message, up to the size that
/// wire_guard.h allows.

#include <geometry_msgs/TwistStamped.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float64.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>

namespace robot_control {

/// `Least` and `Most` are bounds of the message's length on the wire, in bytes.
template <class Message, std::uint32_t Least, std::uint32_t Most = Least>
struct Bounded {
  using ConstPtr = boost::shared_ptr<const Bounded>;

  Message message;
  bool accepted = false;
};

/// A frame_id has at most this many bytes.
inline constexpr std::uint32_t kMaxFrameId = 256;

using BoundedBool = Bounded<std_msgs::Bool, 1>;
using BoundedEmpty = Bounded<std_msgs::Empty, 0>;
using BoundedFloat64 = Bounded<std_msgs::Float64, 8>;
using BoundedTwist = Bounded<geometry_msgs::Twist, 48>;
using BoundedTwistStamped = Bounded<geometry_msgs::TwistStamped, 64, 64 + kMaxFrameId>;

}  // namespace robot_control

namespace ros {

namespace message_traits {
// A publisher sees the type of the message itself.
template <class Message, std::uint32_t Least, std::uint32_t Most>
struct MD5Sum<robot_control::Bounded<Message, Least, Most>> : MD5Sum<Message> {};
template <class Message, std::uint32_t Least, std::uint32_t Most>
struct DataType<robot_control::Bounded<Message, Least, Most>> : DataType<Message> {};
template <class Message, std::uint32_t Least, std::uint32_t Most>
struct Definition<robot_control::Bounded<Message, Least, Most>> : Definition<Message> {};
}  // namespace message_traits

namespace serialization {
template <class Message, std::uint32_t Least, std::uint32_t Most>
struct Serializer<robot_control::Bounded<Message, Least, Most>> {
  template <class Stream>
  static void read(Stream& stream, robot_control::Bounded<Message, Least, Most>& to) {
    if (stream.getLength() < Least || stream.getLength() > Most) return;
    try {
      stream.next(to.message);
      to.accepted = true;
    } catch (const StreamOverrunException&) {  // a length inside the message is wrong
    }
  }
};
}  // namespace serialization

}  // namespace ros
