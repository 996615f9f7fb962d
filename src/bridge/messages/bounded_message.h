#pragma once
/// A message that is looked at only if it is as long as its type can be.
///
/// roscpp hands over whatever a publisher sent, and where it is too short throws and logs once per message: a broken or
/// hostile sender would fill the log. Here its length on the wire is judged first; what is out of bounds is neither
/// copied nor parsed, `accepted` stays false. (Before that roscpp has already received it, up to what wire_guard.h
/// allows.)

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>

#include "bridge/messages/messages.h"

namespace robot_control {

/// `Least`, `Most`: bytes on the wire.
template <class Message, std::uint32_t Least, std::uint32_t Most = Least>
struct Bounded {
  using ConstPtr = boost::shared_ptr<const Bounded>;

  Message message;
  bool accepted = false;
};

/// The longest accepted frame_id.
inline constexpr std::uint32_t kMaxFrameId = 256;

using BoundedBool = Bounded<msg::Bool, 1>;
using BoundedEmpty = Bounded<msg::Empty, 0>;
using BoundedFloat64 = Bounded<msg::Float64, 8>;
using BoundedTwist = Bounded<msg::Twist, 48>;
using BoundedTwistStamped = Bounded<msg::TwistStamped, 64, 64 + kMaxFrameId>;

}  // namespace robot_control

namespace ros {

namespace message_traits {
// To its publisher it is the message itself.
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
    } catch (const StreamOverrunException&) {  // a length within it is wrong
    }
  }
};
}  // namespace serialization

}  // namespace ros
