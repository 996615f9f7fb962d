// Checks which bytes a publisher may send, and which part of them is read.
#include "ros/messages/bounded_message.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <robot_control/SafetyStatus.h>

namespace robot_control::tests {

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

geometry_msgs::TwistStamped stamped(std::size_t name_length) {
  geometry_msgs::TwistStamped message;
  message.header.frame_id = std::string(name_length, 'a');
  message.twist.linear.x = 0.5;
  return message;
}

constexpr std::size_t kFrameIdLength = 12;  // after seq and stamp

TEST(BoundedMessage, TakesEveryMessageOfItsType) {
  geometry_msgs::Twist twist;
  twist.angular.z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(read<BoundedTwist>(wire(twist)).accepted);
  EXPECT_TRUE(read<BoundedBool>(wire(std_msgs::Bool{})).accepted);
  EXPECT_TRUE(read<BoundedEmpty>(wire(std_msgs::Empty{})).accepted);
  EXPECT_TRUE(read<BoundedFloat64>(wire(std_msgs::Float64{})).accepted);
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

TEST(ArrayBound, AllocatesNoArrayThatOnlyItsLengthFieldAnnounces) {
  for (const std::uint32_t length : {1u << 16, 1u << 24, 0xffffffffu}) {
    Bytes bytes = wire(dynamic_reconfigure::Reconfigure::Request{});
    set_length(bytes, 0, length);
    EXPECT_THROW(read<dynamic_reconfigure::Reconfigure::Request>(bytes), ros::serialization::StreamOverrunException)
        << length;
  }
}

TEST(ArrayBound, TakesTheShortestElements) {
  diagnostic_msgs::DiagnosticStatus status;
  status.values.resize(1000);
  EXPECT_EQ(read<diagnostic_msgs::DiagnosticStatus>(wire(status)).values.size(), 1000);
  dynamic_reconfigure::Config config;
  config.bools.resize(1000);
  EXPECT_EQ(read<dynamic_reconfigure::Config>(wire(config)).bools.size(), 1000);
  SafetyStatus sentences;
  sentences.sentences.resize(1000);
  EXPECT_EQ(read<SafetyStatus>(wire(sentences)).sentences.size(), 1000);
}

TEST(BoundedMessage, IsTheMessageItselfToItsPublisher) {
  EXPECT_STREQ(ros::message_traits::datatype<BoundedTwist>(), "geometry_msgs/Twist");
  EXPECT_STREQ(ros::message_traits::md5sum<BoundedTwist>(), ros::message_traits::md5sum<geometry_msgs::Twist>());
}

}  // namespace robot_control::tests
