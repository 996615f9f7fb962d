/// Bytes by hand from the formulas of PyPI damiao-motor 1.0.6 (core/motor.py).

#include <gtest/gtest.h>

#include <random>

#include "drivers/damiao/damiao_messages.h"

namespace robot_control::damiao::tests {

constexpr MitRanges kRanges{.position = 12.5, .velocity = 30, .torque = 10};

can_frame frame_of(canid_t id, std::initializer_list<std::uint8_t> bytes) {
  return data_frame(id, std::vector(bytes));
}

TEST(Damiao, AnOrderOfZerosIsHalfAStepBelowTheMiddleOfTheRanges) {
  const can_frame frame = encode_mit(3, kRanges, {});
  EXPECT_EQ(frame.can_id, 3u);
  ASSERT_EQ(frame.len, 8);
  EXPECT_EQ(data_word(frame), data_word(frame_of(3, {0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF})));
}

/// 6.25 rad: ⌊18.75 · 65535/25⌋ = 49151; −15 rad/s: ⌊15 · 4095/60⌋ = 1023; 60: ⌊60 · 4095/500⌋ = 491; 2: ⌊2 · 819⌋ =
/// 1638; 5 N·m: ⌊15 · 4095/20⌋ = 3071.
TEST(Damiao, AnOrderHoldsItsNumbersInTheirOrder) {
  const MitCommand command{.position = 6.25, .velocity = -15, .stiffness = 60, .damping = 2, .torque = 5};
  EXPECT_EQ(data_word(encode_mit(1, kRanges, command)),
            data_word(frame_of(1, {0xBF, 0xFF, 0x3F, 0xF1, 0xEB, 0x66, 0x6B, 0xFF})));
}

TEST(Damiao, NumbersBeyondTheirRangeAreThoseOfItsEnds) {
  const MitCommand above{.position = 99, .velocity = 99, .stiffness = 900, .damping = 9, .torque = 99};
  EXPECT_EQ(data_word(encode_mit(1, kRanges, above)), ~std::uint64_t{0});
  const MitCommand below{.position = -99, .velocity = -99, .stiffness = -1, .damping = -1, .torque = -99};
  EXPECT_EQ(data_word(encode_mit(1, kRanges, below)), 0u);
}

TEST(Damiao, AnOrderIsReadAsWithinOneStepOfItsNumbers) {
  std::mt19937_64 random(7);
  const auto drawn = [&random](double range) { return std::uniform_real_distribution<>(-range, range)(random); };
  for (int i = 0; i < 10'000; ++i) {
    const MitCommand sent{.position = drawn(12.5),
                          .velocity = drawn(30),
                          .stiffness = 250 + drawn(250),
                          .damping = 2.5 + drawn(2.5),
                          .torque = drawn(10)};
    const MitCommand read = decode_mit(encode_mit(1, kRanges, sent), kRanges);
    ASSERT_NEAR(read.position, sent.position, 25.0 / 65535);
    ASSERT_NEAR(read.velocity, sent.velocity, 60.0 / 4095);
    ASSERT_NEAR(read.stiffness, sent.stiffness, 500.0 / 4095);
    ASSERT_NEAR(read.damping, sent.damping, 5.0 / 4095);
    ASSERT_NEAR(read.torque, sent.torque, 20.0 / 4095);
  }
}

TEST(Damiao, FeedbackHoldsStateNumberMotionTorqueAndTemperatures) {
  const Feedback feedback = decode_feedback(frame_of(17, {0x93, 0xFF, 0xFF, 0x00, 0x0F, 0xFF, 0x28, 0x2A}), kRanges);
  EXPECT_EQ(feedback.node, 3);
  EXPECT_EQ(feedback.state, State::kUnderVoltage);
  EXPECT_DOUBLE_EQ(feedback.position, 12.5);
  EXPECT_DOUBLE_EQ(feedback.velocity, -30);
  EXPECT_DOUBLE_EQ(feedback.torque, 10);
  EXPECT_EQ(feedback.transistors, 40);
  EXPECT_EQ(feedback.rotor, 42);
}

TEST(Damiao, ARequestIsSevenFullBytesAndItsOwn) {
  const can_frame frame = encode(9, Request::kEnable);
  EXPECT_EQ(frame.can_id, 9u);
  EXPECT_EQ(data_word(frame), data_word(frame_of(9, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC})));
  EXPECT_EQ(decode_request(frame), Request::kEnable);
  EXPECT_EQ(decode_request(encode_mit(9, kRanges, {})), std::nullopt);
}

TEST(Damiao, ARegisterIsReadAndWrittenLittleEndian) {
  const RegisterAccess write{
      .node = 3, .operation = Operation::kWrite, .number = Register::kTimeout, .value = 2000};  // 0.1 s
  const can_frame frame = encode(kRegisterId, write);
  EXPECT_EQ(frame.can_id, 0x7FFu);
  EXPECT_EQ(data_word(frame), data_word(frame_of(0x7FF, {0x03, 0x00, 0x55, 0x09, 0xD0, 0x07, 0x00, 0x00})));
  const RegisterAccess answer = decode_register(frame_of(17, {0x03, 0x00, 0x33, 0x15, 0x00, 0x00, 0x48, 0x41}));
  EXPECT_EQ(answer.node, 3);
  EXPECT_EQ(answer.operation, Operation::kRead);
  EXPECT_EQ(answer.number, Register::kPositionRange);
  EXPECT_EQ(answer.real(), 12.5);
}

}  // namespace robot_control::damiao::tests
