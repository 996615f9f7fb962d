/// Bytes by hand from the manual of the CyberGear (belovictor/cybergear-docs, 4.1).

#include <gtest/gtest.h>

#include "drivers/cybergear/cybergear_messages.h"

namespace robot_control::cybergear::tests {

constexpr MitRanges kRanges{.position = 12.5, .velocity = 30, .torque = 12};

can_frame frame_of(canid_t id, std::initializer_list<std::uint8_t> bytes) {
  return data_frame(CAN_EFF_FLAG | id, std::vector(bytes));
}

/// 6.25 rad: ⌊18.75 · 65535/25⌋ = 49151; −15 rad/s: ⌊15 · 65535/60⌋ = 16383; 60: ⌊60 · 65535/500⌋ = 7864; 2: 26214;
/// 3 N·m: ⌊15 · 65535/24⌋ = 40959 = 9FFFh, in the identifier.
TEST(Cybergear, AnOrderHoldsItsNumbersInTheirOrder) {
  const MitCommand command{.position = 6.25, .velocity = -15, .stiffness = 60, .damping = 2, .torque = 3};
  const can_frame frame = encode_order(0x7F, kRanges, command);
  EXPECT_EQ(frame.can_id, CAN_EFF_FLAG | 0x019FFF7FU);
  EXPECT_EQ(data_word(frame), data_word(frame_of(0, {0xBF, 0xFF, 0x3F, 0xFF, 0x1E, 0xB8, 0x66, 0x66})));
  const MitCommand read = decode_order(frame, kRanges);
  EXPECT_NEAR(read.position, 6.25, 25.0 / 65535);
  EXPECT_NEAR(read.torque, 3, 24.0 / 65535);
}

TEST(Cybergear, FeedbackHoldsNumberFaultsModeMotionAndTemperature) {
  // Type 2, mode 2, faults 000101, motor 5, host FDh.
  const Feedback feedback = decode_feedback(frame_of(0x028505FD, {0xFF, 0xFF, 0, 0, 0xFF, 0xFF, 0x01, 0x90}), kRanges);
  EXPECT_EQ(feedback.node, 5);
  EXPECT_EQ(feedback.mode, Mode::kRun);
  EXPECT_EQ(feedback.faults, 0b101);
  EXPECT_DOUBLE_EQ(feedback.position, 12.5);
  EXPECT_DOUBLE_EQ(feedback.velocity, -30);
  EXPECT_DOUBLE_EQ(feedback.torque, 12);
  EXPECT_DOUBLE_EQ(feedback.temperature, 40);
}

TEST(Cybergear, AParameterIsReadAndWrittenLittleEndian) {
  const can_frame write = encode({.type = Type::kWrite, .data = kHost, .target = 5},
                                 {.index = Parameter::kTimeout, .value = 2000});  // 0.1 s
  EXPECT_EQ(write.can_id, CAN_EFF_FLAG | 0x1200FD05U);
  EXPECT_EQ(data_word(write), data_word(frame_of(0, {0x28, 0x70, 0, 0, 0xD0, 0x07, 0, 0})));
  const ParameterAccess answer = decode_parameter(frame_of(0x110005FD, {0x0B, 0x70, 0, 0, 0, 0, 0x40, 0x41}));
  EXPECT_EQ(answer.index, Parameter::kTorqueLimit);
  EXPECT_EQ(answer.real(), 12);
}

TEST(Cybergear, RequestsCarryTheHost) {
  EXPECT_EQ(encode_request(Type::kEnable, 5).can_id, CAN_EFF_FLAG | 0x0300FD05U);
  EXPECT_EQ(encode_request(Type::kRelease, 5, 1).data[0], 1);
  EXPECT_EQ(encode_request(Type::kRelease, 5, 1).len, 8);
}

TEST(Cybergear, AFrameOfAnotherLengthOrWithoutTwentyNineBitsIsNone) {
  EXPECT_FALSE(identifier_of(word_frame(0x205, 0, 8)));
  EXPECT_FALSE(identifier_of(word_frame(CAN_EFF_FLAG | 0x028005FDU, 0, 7)));
  EXPECT_TRUE(identifier_of(word_frame(CAN_EFF_FLAG | 0x028005FDU, 0, 8)));
}

}  // namespace robot_control::cybergear::tests
