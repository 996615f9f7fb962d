// Checks which bytes a publisher may send, and which part of them is read.
#include "ros/messages/bounded_message.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "ros/messages/reconfigure_messages.h"

namespace robot_control {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class Message>
Bytes wire(const Message& message) {
  Bytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <class BoundedMessage>
BoundedMessage read(Bytes bytes) {
  BoundedMessage message;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
  return message;
}

/// A length field, little endian, at `place`.
void set_length(Bytes& bytes, std::size_t place, std::uint32_t length) {
  for (std::size_t i = 0; i < 4; ++i) bytes[place + i] = static_cast<std::uint8_t>(length >> (8 * i));
}

msg::TwistStamped stamped(std::size_t name_length) {
  msg::TwistStamped message;
  message.header.frame_id = std::string(name_length, 'a');
  message.twist.linear.x = 0.5;
  return message;
}

constexpr std::size_t kFrameIdLength = 12;  // after seq and stamp

TEST(BoundedMessage, TakesEveryMessageOfItsType) {
  msg::Twist twist;
  twist.angular.z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(read<BoundedTwist>(wire(twist)).accepted);
  EXPECT_TRUE(read<BoundedBool>(wire(msg::Bool{})).accepted);
  EXPECT_TRUE(read<BoundedEmpty>(wire(msg::Empty{})).accepted);
  EXPECT_TRUE(read<BoundedFloat64>(wire(msg::Float64{})).accepted);
  const BoundedTwistStamped longest = read<BoundedTwistStamped>(wire(stamped(kMaxFrameId)));
  EXPECT_TRUE(longest.accepted);
  EXPECT_EQ(longest.message.twist.linear.x, 0.5);
}

TEST(BoundedMessage, RefusesAnotherLengthWithoutAnException) {
  for (const std::size_t size : {0, 1, 47, 49, 1000000}) {
    EXPECT_FALSE(read<BoundedTwist>(Bytes(size)).accepted) << size;
  }
  EXPECT_FALSE(read<BoundedBool>(Bytes(0)).accepted);
  EXPECT_FALSE(read<BoundedBool>(Bytes(2)).accepted);
  EXPECT_FALSE(read<BoundedEmpty>(Bytes(1)).accepted);
  EXPECT_FALSE(read<BoundedFloat64>(Bytes(7)).accepted);
}

TEST(BoundedMessage, CopiesNoNameThatIsTooLong) {
  const BoundedTwistStamped received = read<BoundedTwistStamped>(wire(stamped(kMaxFrameId + 1)));
  EXPECT_FALSE(received.accepted);
  EXPECT_TRUE(received.message.header.frame_id.empty());
}

TEST(BoundedMessage, RefusesANameThatPointsBeyondTheMessage) {
  for (const std::uint32_t length : {6u, 1000u, 0x7fffffffu, 0xffffffffu}) {
    Bytes bytes = wire(stamped(5));
    set_length(bytes, kFrameIdLength, length);
    EXPECT_FALSE(read<BoundedTwistStamped>(bytes).accepted) << length;
  }
}

TEST(MessageAllocator, AllocatesNoArrayThatOnlyItsLengthFieldAnnounces) {
  for (const std::uint32_t length : {1u << 16, 1u << 24, 0xffffffffu}) {
    Bytes bytes = wire(msg::ReconfigureRequest{});
    set_length(bytes, 0, length);
    EXPECT_THROW(read<msg::ReconfigureRequest>(bytes), std::length_error) << length;
  }
}

TEST(BoundedMessage, IsTheMessageItselfToItsPublisher) {
  EXPECT_STREQ(ros::message_traits::datatype<BoundedTwist>(), "geometry_msgs/Twist");
  EXPECT_STREQ(ros::message_traits::md5sum<BoundedTwist>(), ros::message_traits::md5sum<msg::Twist>());
}

}  // namespace
}  // namespace robot_control
