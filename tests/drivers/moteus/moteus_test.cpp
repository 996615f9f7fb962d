/// Bytes of mjbots/moteus, docs/protocol/can.md and docs/integration/can-fd.md, and some by hand.

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/moteus/moteus_messages.h"

namespace robot_control::moteus::tests {

can_frame frame_of(canid_t id, std::initializer_list<std::uint8_t> bytes) {
  can_frame frame{};
  frame.can_id = id;
  frame.flags = CANFD_FDF;
  frame.len = static_cast<std::uint8_t>(bytes.size());
  std::ranges::copy(bytes, frame.data);
  return frame;
}

std::vector<std::uint8_t> bytes_of(const can_frame& frame) {
  return {frame.data, frame.data + frame.len};
}

TEST(Moteus, AnOrderHoldsSixNumbersATimeoutNoLimitAndTheQuery) {
  const MitRanges gains{.stiffness = 100, .damping = 10};
  const MitCommand command{.position = kTurn, .velocity = 2 * kTurn, .stiffness = 50, .damping = 10, .torque = -1};
  const can_frame frame =
      encode(1, gains, {.mode = Mode::kPosition, .command = command, .max_torque = 2, .timeout = 0.5});
  EXPECT_EQ(frame.can_id, CAN_EFF_FLAG | 0x8001);
  EXPECT_EQ(frame.flags, CANFD_FDF | CANFD_BRS);
  EXPECT_EQ(bytes_of(frame),
            (std::vector<std::uint8_t>{0x01, 0x00, 0x0A, 0x0C, 6,    0x20, 0,    0,    0x80, 0x3F, 0,    0,
                                       0,    0x40, 0,    0,    0x80, 0xBF, 0,    0,    0,    0x3F, 0,    0,
                                       0x80, 0x3F, 0,    0,    0,    0x40, 0x0D, 0x27, 0,    0,    0,    0x3F,
                                       0x02, 0x28, 0xFF, 0xFF, 0x11, 0x00, 0x1F, 0x01, 0x13, 0x0D, 0x50, 0x50}));
}

TEST(Moteus, AStopAsksForTheStateAndTheIdentity) {
  EXPECT_EQ(bytes_of(encode(3, {}, Request{})),
            (std::vector<std::uint8_t>{0x01, 0, 0, 0x11, 0, 0x1F, 1, 0x13, 0x0D, 0x50, 0x50, 0x50}));
  EXPECT_EQ(
      bytes_of(encode(3, {}, Request{.details = true})),
      (std::vector<std::uint8_t>{0x01, 0, 0, 0x11, 0, 0x1F, 1, 0x13, 0x0D, 0x11, 0x0C, 0x19, 0x82, 0x02, 0x1F, 0x30}));
}

can_frame good_reply(canid_t id = 0x100) {
  return frame_of(
      id, {0x21, 0, 10, 0x2F, 1, 0, 0, 0x80, 0x3E, 0, 0, 0, 0, 0, 0, 0xC0, 0x3F, 0x23, 0x0D, 50, 30, 0, 0x50, 0x50});
}

TEST(Moteus, AReplyIsReadInSiUnits) {
  const auto reply = decode_reply(good_reply(), 1);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->mode, 10);
  EXPECT_DOUBLE_EQ(reply->position, kTurn / 4);
  EXPECT_EQ(reply->velocity, 0);
  EXPECT_EQ(reply->torque, 1.5);
  EXPECT_EQ(reply->voltage, 25);
  EXPECT_EQ(reply->temperature, 30);
  EXPECT_FALSE(reply->details);
}

TEST(Moteus, ANumberThatIsNotFiniteStaysSo) {
  can_frame frame = good_reply();
  frame.data[7] = frame.data[8] = 0xFF;
  EXPECT_TRUE(std::isnan(decode_reply(frame, 1)->position));
  frame = good_reply();
  frame.data[20] = 0x80;
  EXPECT_TRUE(std::isnan(decode_reply(frame, 1)->temperature));
  frame = good_reply();
  frame.data[2] = 0x80;
  EXPECT_FALSE(decode_reply(frame, 1)) << "a mode";
}

TEST(Moteus, AnotherIdentifierLengthOrKindIsNoReply) {
  EXPECT_FALSE(decode_reply(good_reply(), 2));
  EXPECT_FALSE(decode_reply(good_reply(0x101), 1)) << "for another program";
  EXPECT_FALSE(decode_reply(good_reply(0x10100), 1)) << "with a prefix";
  EXPECT_TRUE(decode_reply(good_reply(0x100 | CAN_EFF_FLAG), 1));
  for (std::uint8_t length = 0; length < 22; ++length) {
    can_frame cut = good_reply();
    cut.len = length;
    EXPECT_FALSE(decode_reply(cut, 1)) << int{length};
  }
  can_frame classic = good_reply();
  classic.flags = 0;
  EXPECT_FALSE(decode_reply(classic, 1));
  can_frame other = good_reply();
  other.data[0] = 0x01;
  EXPECT_FALSE(decode_reply(other, 1)) << "writes";
}

TEST(Moteus, AFrameThatReadsAloneCommandsNothing) {
  EXPECT_FALSE(commands(frame_of(0x8101, {0x11, 0, 0x1F, 1}), 1));
  EXPECT_FALSE(commands(good_reply(), 1));
  EXPECT_FALSE(commands(encode(2, {}, Request{}), 1));
  EXPECT_TRUE(commands(encode(2, {}, Request{}), 2));
  EXPECT_TRUE(commands(frame_of(0x017F, {0x01, 0, 0}), 2)) << "to all";
}

TEST(Moteus, ARequestComesBackAsItWasMade) {
  const MitRanges gains{.stiffness = 100, .damping = 10};
  const MitCommand command{.position = kTurn, .velocity = 2 * kTurn, .stiffness = 50, .damping = 10, .torque = -1};
  for (const bool details : {false, true}) {
    const can_frame frame = encode(
        1, gains, {.mode = Mode::kPosition, .command = command, .max_torque = 2, .timeout = 0.5, .details = details});
    const auto request = decode_request(frame, 1, gains);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->mode, Mode::kPosition);
    EXPECT_EQ(request->command.stiffness, 50);
    EXPECT_EQ(request->command.torque, -1);
    EXPECT_EQ(request->max_torque, 2);
    EXPECT_EQ(request->details, details);
    EXPECT_FALSE(decode_request(frame, 2, gains));
    EXPECT_EQ(frame.len, details ? 64 : 48);
  }
  EXPECT_EQ(decode_request(encode(1, gains, Request{}), 1, gains)->mode, Mode::kStopped);
}

}  // namespace robot_control::moteus::tests
