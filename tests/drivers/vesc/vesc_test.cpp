/// Bytes by hand from the source of the firmware (comm/comm_can.c).

#include <gtest/gtest.h>

#include "drivers/vesc/vesc_messages.h"

namespace robot_control::vesc::tests {

can_frame frame_of(std::uint32_t command, std::uint8_t node, std::initializer_list<std::uint8_t> bytes) {
  return data_frame(CAN_EFF_FLAG | command << 8U | node, std::vector(bytes));
}

TEST(Vesc, ACurrentIsMilliamperesOfFourBytesWithTheHighestOneFirst) {
  const can_frame frame = encode(10, SetCurrent{.current = -1.5});
  EXPECT_EQ(frame.can_id, CAN_EFF_FLAG | 0x010Au);
  ASSERT_EQ(frame.len, 4);
  EXPECT_EQ(data_word(frame), data_word(frame_of(1, 10, {0xFF, 0xFF, 0xFA, 0x24})));
  EXPECT_EQ(node_of(frame), 10);
}

TEST(Vesc, ASpeedIsElectricalRevolutionsPerMinute) {
  const can_frame frame = encode(0, SetSpeed{.speed = 1000 * kSpeedUnit});
  EXPECT_EQ(frame.can_id, CAN_EFF_FLAG | 0x0300u);
  EXPECT_EQ(data_word(frame), data_word(frame_of(3, 0, {0x00, 0x00, 0x03, 0xE8})));
}

TEST(Vesc, AStatusHoldsSpeedCurrentAndDuty) {
  const auto status = decode<Status>(frame_of(9, 200, {0xFF, 0xFF, 0xFC, 0x18, 0x00, 0x7B, 0xFE, 0x0C}));
  ASSERT_TRUE(status);
  EXPECT_DOUBLE_EQ(status->speed, -1000 * kSpeedUnit);
  EXPECT_DOUBLE_EQ(status->current, 12.3);
  EXPECT_DOUBLE_EQ(status->duty, -0.5);
}

TEST(Vesc, StatusFourHoldsTemperaturesAndStatusFiveTheTachometerAndTheSupply) {
  const auto four = decode<Status4>(frame_of(16, 1, {0x01, 0x5E, 0x01, 0x90, 0xFF, 0xF6, 0x00, 0x00}));
  ASSERT_TRUE(four);
  EXPECT_DOUBLE_EQ(four->transistors, 35);
  EXPECT_DOUBLE_EQ(four->motor, 40);
  EXPECT_DOUBLE_EQ(four->input_current, -1);
  const auto five = decode<Status5>(frame_of(27, 1, {0x80, 0x00, 0x00, 0x00, 0x00, 0xF0, 0x12, 0x34}));
  ASSERT_TRUE(five);
  EXPECT_EQ(five->tachometer, std::numeric_limits<std::int32_t>::min());
  EXPECT_DOUBLE_EQ(five->voltage, 24);
}

TEST(Vesc, OtherFramesAreNotThisMessage) {
  const can_frame good = encode(1, Status{});
  ASSERT_TRUE(decode<Status>(good));
  can_frame other = good;
  other.can_id &= ~CAN_EFF_FLAG;
  EXPECT_FALSE(decode<Status>(other));
  other.can_id = good.can_id | CAN_RTR_FLAG;
  EXPECT_FALSE(decode<Status>(other));
  other = good;
  other.len = 7;
  EXPECT_FALSE(decode<Status>(other));
  EXPECT_FALSE(decode<Status4>(good));
  other.can_id = good.can_id | 1U << 16U;  // a command of more than 8 bits
  other.len = 8;
  EXPECT_FALSE(decode<Status>(other));
}

TEST(Vesc, ACurrentBeyondTheRangeSaturatesAndNanIsNone) {
  EXPECT_EQ(decode<SetCurrent>(encode(0, SetCurrent{.current = 1e9}))->current, 2147483.647);
  EXPECT_EQ(decode<SetCurrent>(encode(0, SetCurrent{.current = std::numeric_limits<double>::quiet_NaN()}))->current, 0);
}

}  // namespace robot_control::vesc::tests
