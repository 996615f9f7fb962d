#include "drivers/cia402/canopen.h"

#include "support/matchers.h"

namespace robot_control::canopen::tests {

TEST(Canopen, AnNmtCommandIsTwoBytesToAllNodesOrOne) {
  const can_frame frame = encode_nmt({.command = NmtCommand::kStart, .node = 5});
  EXPECT_EQ(frame.can_id, 0u);
  EXPECT_EQ(frame.len, 2);
  EXPECT_EQ(data_word(frame), 0x0501u);
  EXPECT_EQ(data_word(encode_nmt({.command = NmtCommand::kResetNode})), 0x0081u);
  const auto request = decode_nmt(frame);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->command, NmtCommand::kStart);
  EXPECT_EQ(request->node, 5);
}

TEST(Canopen, AHeartbeatIsTheStateUnderTheNodesIdentifier) {
  const can_frame frame = encode_heartbeat({.node = 0x12, .state = NmtState::kPreOperational});
  EXPECT_EQ(frame.can_id, 0x712u);
  EXPECT_EQ(frame.len, 1);
  EXPECT_EQ(frame.data[0], 0x7F);
  const auto toggled = decode_heartbeat(word_frame(0x712, 0x85, 1));
  ASSERT_TRUE(toggled);
  EXPECT_EQ(toggled->node, 0x12);
  EXPECT_EQ(toggled->state, NmtState::kOperational);
}

TEST(Canopen, OtherFramesAreNoHeartbeat) {
  EXPECT_FALSE(decode_heartbeat(word_frame(0x700, 5, 1))) << "node 0";
  EXPECT_FALSE(decode_heartbeat(word_frame(0x692, 5, 1)));
  EXPECT_FALSE(decode_heartbeat(word_frame(0x712, 5, 0)));
  EXPECT_FALSE(decode_heartbeat(word_frame(0x712, 5, 2)));
  EXPECT_FALSE(decode_heartbeat(word_frame(0x712 | CAN_RTR_FLAG, 0, 1))) << "a request of node guarding";
  EXPECT_FALSE(decode_heartbeat(word_frame(0x712 | CAN_EFF_FLAG, 5, 1)));
}

TEST(Canopen, SyncHasNoDataAndIsNoEmergency) {
  EXPECT_EQ(sync_frame().can_id, 0x080u);
  EXPECT_EQ(sync_frame().len, 0);
  EXPECT_FALSE(decode_emergency(sync_frame()));
  EXPECT_FALSE(decode_emergency(word_frame(0x080, 0, 8)));
}

TEST(Canopen, AnEmergencyHasCodeRegisterAndFiveBytesOfTheMaker) {
  const can_frame frame =
      encode_emergency({.node = 7, .code = 0x8130, .error_register = 0x11, .specific = {1, 2, 3, 4, 5}});
  EXPECT_EQ(frame.can_id, 0x087u);
  EXPECT_EQ(data_word(frame), 0x05040302'01118130u);
  const auto emergency = decode_emergency(frame);
  ASSERT_TRUE(emergency);
  EXPECT_EQ(emergency->node, 7);
  EXPECT_EQ(emergency->code, 0x8130);
  EXPECT_EQ(emergency->error_register, 0x11);
  EXPECT_THAT(emergency->specific, ElementsAre(1, 2, 3, 4, 5));
  EXPECT_FALSE(decode_emergency(word_frame(0x087, 0, 7)));
}

TEST(Canopen, TheHeartbeatConsumerHoldsNodeAndTime) {
  EXPECT_EQ(heartbeat_consumer(0x7F, 20), 0x007F0014u);
}

TEST(Canopen, ErrorCodesHaveWordsOrThoseOfTheirClass) {
  EXPECT_STREQ(error_code_words(0x8130), "heartbeat or life guard error: the host was silent");
  EXPECT_STREQ(error_code_words(0x8131), "communication");
  EXPECT_STREQ(error_code_words(0x3220), "DC link under-voltage");
  EXPECT_STREQ(error_code_words(0x3277), "voltage inside the device");
  EXPECT_STREQ(error_code_words(0x3999), "voltage");
  EXPECT_STREQ(error_code_words(0x0000), "error reset or no error");
  EXPECT_STREQ(error_code_words(0xFF12), "device specific");
  EXPECT_STREQ(error_code_words(0xE000), "unknown error");
}

}  // namespace robot_control::canopen::tests
