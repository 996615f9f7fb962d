/// Bytes by hand from the formulas of PyPI mini-cheetah-motor-driver-socketcan 0.4.3 (motor_driver/canmotorlib.py).

#include <gtest/gtest.h>

#include "drivers/ak/ak_messages.h"

namespace robot_control::ak::tests {

constexpr MitRanges kRanges{.position = 12.5, .velocity = 50, .torque = 18};

TEST(Ak, AReplyHoldsNumberMotionAndTorque) {
  const std::vector<std::uint8_t> bytes{0x05, 0xFF, 0xFF, 0x00, 0x0F, 0xFF};
  const auto reply = decode_reply(data_frame(0, bytes), kRanges);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->node, 5);
  EXPECT_DOUBLE_EQ(reply->position, 12.5);
  EXPECT_DOUBLE_EQ(reply->velocity, -50);
  EXPECT_DOUBLE_EQ(reply->torque, 18);
  EXPECT_FALSE(reply->health);
}

TEST(Ak, NewerFirmwareAddsTemperatureAndError) {
  const std::vector<std::uint8_t> bytes{0x05, 0, 0, 0, 0, 0, 75, 5};
  const auto reply = decode_reply(data_frame(0, bytes), kRanges);
  ASSERT_TRUE(reply && reply->health);
  EXPECT_EQ(reply->health->temperature, 75);
  EXPECT_EQ(reply->health->error, Error::kEncoder);
}

TEST(Ak, AnotherLengthOrIdentifierIsNoReply) {
  EXPECT_FALSE(decode_reply(word_frame(0, 5, 7), kRanges));
  EXPECT_FALSE(decode_reply(word_frame(5, 5, 6), kRanges));
  EXPECT_FALSE(decode_reply(word_frame(CAN_EFF_FLAG, 5, 6), kRanges));
}

}  // namespace robot_control::ak::tests
