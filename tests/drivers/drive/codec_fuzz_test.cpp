/// Random and mutated frames pass through every decoder without a crash under the sanitizers. An accepted frame has one
/// meaning: encoded and decoded again it is the same.

#include <gtest/gtest.h>

#include <random>

#include "drivers/cia402/drive_objects.h"
#include "drivers/cia402/power_state.h"
#include "drivers/cia402/sdo.h"
#include "drivers/odrive/odrive_catalogue.h"
#include "drivers/vesc/vesc_messages.h"

namespace robot_control::tests {

constexpr int kFrames = 10'000;  // per dialect

/// Half of the frames are any bytes; the others are valid ones with a few bits changed.
class Frames {
 public:
  explicit Frames(std::vector<can_frame> valid) : valid_(std::move(valid)) {}

  can_frame next() {
    can_frame frame{};
    if (random_() % 2 == 0) {
      frame.can_id = static_cast<canid_t>(random_() % 8 == 0 ? random_() : random_() & CAN_SFF_MASK);
      frame.len = static_cast<std::uint8_t>(random_() % 4 == 0 ? random_() : random_() % 9);
      for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random_());
      return frame;
    }
    frame = valid_[random_() % valid_.size()];
    for (auto changes = random_() % 4; changes > 0; --changes) {
      frame.data[random_() % 8] ^= static_cast<std::uint8_t>(1U << random_() % 8);
    }
    if (random_() % 8 == 0) frame.can_id ^= canid_t{1} << random_() % 32;
    if (random_() % 8 == 0) frame.len = static_cast<std::uint8_t>(random_());
    return frame;
  }

 private:
  std::mt19937 random_{29};
  std::vector<can_frame> valid_;
};

/// Passes a message to all decoders; the number of those that accept it is added.
struct OdriveCheck {
  const can_frame& frame;
  int& accepted;

  template <class Message>
  void operator()(const char* name) const {
    const auto message = odrive::decode<Message>(frame);
    if (!message) return;
    ++accepted;
    const std::uint64_t once = packed(*message);
    const auto again = odrive::decode<Message>(odrive::encode(odrive::node_of(frame), *message));
    ASSERT_TRUE(again) << name;
    ASSERT_EQ(packed(*again), once) << name << ", data " << std::hex << data_word(frame);
  }
};

TEST(CodecFuzz, ODriveFramesHaveOneMeaningOrNone) {
  std::vector<can_frame> valid;
  const auto add = [&valid]<class Message>(const char*) { valid.push_back(odrive::encode(3, Message{})); };
  odrive::visit_05(add);
  odrive::visit_06(add);
  Frames frames(valid);
  int accepted = 0;
  for (int i = 0; i < kFrames; ++i) {
    const can_frame frame = frames.next();
    const OdriveCheck check{frame, accepted};
    odrive::visit_05([&check]<class Message>(const char* name) { check.operator()<Message>(name); });
    odrive::visit_06([&check]<class Message>(const char* name) { check.operator()<Message>(name); });
  }
  EXPECT_GT(accepted, kFrames / 2);
}

TEST(CodecFuzz, VescFramesHaveOneMeaningOrNone) {
  Frames frames({vesc::encode(3, vesc::SetCurrent{}), vesc::encode(3, vesc::SetSpeed{}),
                 vesc::encode(3, vesc::Status{}), vesc::encode(3, vesc::Status4{}), vesc::encode(3, vesc::Status5{})});
  int accepted = 0;
  const auto check = [&accepted]<class Message>(const can_frame& frame, Message) {
    const auto message = vesc::decode<Message>(frame);
    if (!message) return;
    ++accepted;
    const auto again = vesc::decode<Message>(vesc::encode(vesc::node_of(frame), *message));
    ASSERT_TRUE(again);
    ASSERT_EQ(packed(*again), packed(*message)) << std::hex << data_word(frame);
  };
  for (int i = 0; i < kFrames; ++i) {
    const can_frame frame = frames.next();
    check(frame, vesc::SetCurrent{});
    check(frame, vesc::SetBrakeCurrent{});
    check(frame, vesc::SetSpeed{});
    check(frame, vesc::Status{});
    check(frame, vesc::Status4{});
    check(frame, vesc::Status5{});
  }
  EXPECT_GT(accepted, kFrames / 4);
}

std::vector<can_frame> valid_canopen_frames() {
  using namespace canopen;
  std::vector<can_frame> valid = {encode_nmt({}), sync_frame(), encode_emergency({.node = 1, .code = 0x8130}),
                                  encode_heartbeat({.node = 1, .state = NmtState::kOperational}),
                                  word_frame(0x181, 0x1237, 8)};
  for (const SdoSide side : {SdoSide::kRequest, SdoSide::kResponse}) {
    for (std::uint8_t command = 0; command <= 4; ++command) {
      SdoMessage message{.command = SdoCommand{command}, .expedited = true, .length = 2, .data = {1, 2}};
      valid.push_back(encode_sdo(side, 1, message));
      message.expedited = false;
      message.size = 20;
      valid.push_back(encode_sdo(side, 1, message));
    }
  }
  return valid;
}

int check_canopen(const can_frame& frame) {
  using namespace canopen;
  const cia402::AxisPdos pdos;
  int accepted = 0;
  for (const SdoSide side : {SdoSide::kRequest, SdoSide::kResponse}) {
    const auto message = decode_sdo(side, 1, frame);
    if (!message) continue;
    ++accepted;
    EXPECT_LE(message->length, message->data.size());
    EXPECT_EQ(decode_sdo(side, 1, encode_sdo(side, 1, *message)), message) << std::hex << data_word(frame);
    EXPECT_NE(abort_words(message->abort_code), nullptr);
  }
  if (const auto nmt = decode_nmt(frame)) {
    ++accepted;
    EXPECT_EQ(data_word(encode_nmt(*nmt)), data_word(frame) & 0xFFFFU);
  }
  if (const auto heartbeat = decode_heartbeat(frame)) {
    ++accepted;
    EXPECT_EQ(encode_heartbeat(*heartbeat).can_id, frame.can_id);
  }
  if (const auto emergency = decode_emergency(frame)) {
    ++accepted;
    EXPECT_EQ(data_word(encode_emergency(*emergency)), data_word(frame));
    EXPECT_NE(error_code_words(emergency->code), nullptr);
  }
  std::int64_t values[3] = {};
  if (decode_pdo(pdos.state, 1, frame, values)) {
    ++accepted;
    EXPECT_EQ(data_word(encode_pdo(pdos.state, 1, values)), data_word(frame));
    EXPECT_NE(cia402::power_state_words(cia402::power_state(static_cast<std::uint16_t>(values[0]))), nullptr);
  }
  return accepted;
}

TEST(CodecFuzz, CanopenFramesHaveOneMeaningOrNone) {
  Frames frames(valid_canopen_frames());
  int accepted = 0;
  for (int i = 0; i < kFrames && !::testing::Test::HasFailure(); ++i) accepted += check_canopen(frames.next());
  EXPECT_GT(accepted, kFrames / 4);
}

}  // namespace robot_control::tests
