/// Random and mutated frames pass through every decoder without a crash under the sanitizers. An accepted frame has one
/// meaning: encoded and decoded again it is the same.

#include <gtest/gtest.h>

#include <random>

#include "drivers/ak/ak_messages.h"
#include "drivers/cia402/drive_objects.h"
#include "drivers/cia402/power_state.h"
#include "drivers/cia402/sdo.h"
#include "drivers/cybergear/cybergear_messages.h"
#include "drivers/damiao/damiao_messages.h"
#include "drivers/moteus/moteus_messages.h"
#include "drivers/odrive/odrive_catalogue.h"
#include "drivers/vesc/vesc_messages.h"

namespace robot_control::tests {

constexpr int kFrames = 10'000, kManyFrames = 1'000'000;  // per dialect

/// Half of the frames are any bytes; the others are valid ones with a few bits changed.
class Frames {
 public:
  explicit Frames(std::vector<can_frame> valid) : valid_(std::move(valid)) {}

  can_frame next() {
    can_frame frame{};
    if (random_() % 2 == 0) {
      frame.can_id = static_cast<canid_t>(random_() % 8 == 0 ? random_() : random_() & CAN_SFF_MASK);
      frame.flags = valid_.front().flags;
      frame.len = static_cast<std::uint8_t>(random_() % 4 == 0 ? random_() : random_() % (max_length(frame) + 1));
      for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random_());
      return frame;
    }
    frame = valid_[random_() % valid_.size()];
    for (auto changes = random_() % 4; changes > 0; --changes) {
      frame.data[random_() % (is_fd(frame) ? frame.len : 8)] ^= static_cast<std::uint8_t>(1U << random_() % 8);
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

void expect_one_meaning_of_odrives(int count) {
  std::vector<can_frame> valid;
  const auto add = [&valid]<class Message>(const char*) { valid.push_back(odrive::encode(3, Message{})); };
  odrive::visit_05(add);
  odrive::visit_06(add);
  Frames frames(valid);
  int accepted = 0;
  for (int i = 0; i < count; ++i) {
    const can_frame frame = frames.next();
    const OdriveCheck check{frame, accepted};
    odrive::visit_05([&check]<class Message>(const char* name) { check.operator()<Message>(name); });
    odrive::visit_06([&check]<class Message>(const char* name) { check.operator()<Message>(name); });
  }
  EXPECT_GT(accepted, count / 2);
}

void expect_one_meaning_of_vescs(int count) {
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
  for (int i = 0; i < count; ++i) {
    const can_frame frame = frames.next();
    check(frame, vesc::SetCurrent{});
    check(frame, vesc::SetBrakeCurrent{});
    check(frame, vesc::SetSpeed{});
    check(frame, vesc::Status{});
    check(frame, vesc::Status4{});
    check(frame, vesc::Status5{});
  }
  EXPECT_GT(accepted, count / 4);
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

void expect_one_meaning_of_canopen(int count) {
  Frames frames(valid_canopen_frames());
  int accepted = 0;
  for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) accepted += check_canopen(frames.next());
  EXPECT_GT(accepted, count / 4);
}

constexpr MitRanges kFuzzRanges{.position = 12.5, .velocity = 45, .torque = 54, .stiffness = 500, .damping = 5};
constexpr std::uint8_t kFuzzNode = 3;

/// A number of a range has one meaning up to one step of its field, because the makers round down.
void expect_same(double again, double once, double range, unsigned bits) {
  ASSERT_LE(std::abs(once), range * (1 + 1.0e-12));
  ASSERT_NEAR(again, once, 1.01 * 2 * range / static_cast<double>(low_bits(bits)));
}

void expect_same(const MitCommand& again, const MitCommand& once, unsigned bits) {
  expect_same(again.position, once.position, kFuzzRanges.position, 16);
  expect_same(again.velocity, once.velocity, kFuzzRanges.velocity, bits);
  expect_same(again.stiffness, once.stiffness, kFuzzRanges.stiffness, bits);
  expect_same(again.damping, once.damping, kFuzzRanges.damping, bits);
  expect_same(again.torque, once.torque, kFuzzRanges.torque, bits);
}

/// An answer of any motor.
template <class Answer>
void expect_same_motion(const Answer& again, const Answer& once, unsigned bits) {
  ASSERT_EQ(again.node, once.node);
  expect_same(again.position, once.position, kFuzzRanges.position, 16);
  expect_same(again.velocity, once.velocity, kFuzzRanges.velocity, bits);
  expect_same(again.torque, once.torque, kFuzzRanges.torque, bits);
}

/// Returns whether the frame is accepted.
bool check_order(const can_frame& frame) {
  if (!is_standard_data(frame) || frame.len != CAN_MAX_DLEN) return false;
  const MitCommand order = decode_mit(frame, kFuzzRanges);
  expect_same(decode_mit(encode_mit(kFuzzNode, kFuzzRanges, order), kFuzzRanges), order, 12);
  if (const auto request = decode_request(frame)) {
    EXPECT_EQ(data_word(encode_request(kFuzzNode, *request)), data_word(frame));
  }
  return true;
}

bool check_damiao(const can_frame& frame) {
  using namespace damiao;
  if (!check_order(frame)) return false;
  const Feedback feedback = decode_feedback(frame, kFuzzRanges);
  const Feedback again = decode_feedback(encode(canid_t{19}, kFuzzRanges, feedback), kFuzzRanges);
  expect_same_motion(again, feedback, 12);
  EXPECT_EQ(again.state, feedback.state);
  EXPECT_EQ(again.transistors, feedback.transistors);
  EXPECT_EQ(again.rotor, feedback.rotor);
  EXPECT_EQ(data_word(encode(kRegisterId, decode_register(frame))), data_word(frame));
  return true;
}

bool check_cybergear(const can_frame& frame) {
  using namespace cybergear;
  const auto id = identifier_of(frame);
  if (!id) return false;
  EXPECT_EQ(encode(*id), frame.can_id);
  const MitCommand order = decode_order(frame, kFuzzRanges);
  expect_same(decode_order(encode_order(kFuzzNode, kFuzzRanges, order), kFuzzRanges), order, 16);
  const Feedback feedback = decode_feedback(frame, kFuzzRanges);
  const Feedback again = decode_feedback(encode(std::uint8_t{kHost}, kFuzzRanges, feedback), kFuzzRanges);
  expect_same_motion(again, feedback, 16);
  EXPECT_EQ(again.mode, feedback.mode);
  EXPECT_EQ(again.faults, feedback.faults);
  EXPECT_NEAR(again.temperature, feedback.temperature, 0.11);
  constexpr std::uint64_t kUnused = 0xFFFF0000;  // of a parameter's data
  EXPECT_EQ(data_word(encode(*id, decode_parameter(frame))), data_word(frame) & ~kUnused);
  return true;
}

bool check_ak(const can_frame& frame) {
  const auto reply = ak::decode_reply(frame, kFuzzRanges);
  if (!reply) return false;
  const auto again = ak::decode_reply(ak::encode(kFuzzRanges, *reply), kFuzzRanges);
  EXPECT_TRUE(again.has_value());
  if (!again) return true;
  expect_same_motion(*again, *reply, 12);
  EXPECT_EQ(again->health.has_value(), reply->health.has_value());
  if (!again->health || !reply->health) return true;
  EXPECT_EQ(again->health->temperature, reply->health->temperature);
  EXPECT_EQ(again->health->error, reply->health->error);
  return true;
}

/// The identifier may have 29 bits, and the padding any length.
bool same_data(const can_frame& frame, const can_frame& again) {
  return std::equal(frame.data, frame.data + std::min(frame.len, again.len), again.data);
}

bool check_moteus(const can_frame& frame) {
  using namespace moteus;
  const auto reply = decode_reply(frame, kFuzzNode);
  const auto request = decode_request(frame, kFuzzNode, kFuzzRanges);
  EXPECT_FALSE(reply && (request || commands(frame, kFuzzNode)));
  EXPECT_FALSE(request && !commands(frame, kFuzzNode));
  const bool finite = reply && std::isfinite(reply->position + reply->velocity + reply->torque + reply->voltage +
                                             reply->temperature + reply->home + reply->map_version +
                                             reply->proportional + reply->integral + reply->derivative);
  EXPECT_TRUE(!finite || same_data(frame, encode(kFuzzNode, *reply)));
  const auto again =
      request ? decode_request(encode(kFuzzNode, kFuzzRanges, *request), kFuzzNode, kFuzzRanges) : request;
  EXPECT_EQ(again.has_value(), request.has_value());
  EXPECT_TRUE(!again || (again->mode == request->mode && again->details == request->details));
  return reply || request;
}

/// More than one of `rarity` frames must be accepted.
void expect_one_meaning_of(bool (*check)(const can_frame& frame), std::vector<can_frame> valid, int count,
                           int rarity = 4) {
  Frames frames(std::move(valid));
  int accepted = 0;
  for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) accepted += check(frames.next()) ? 1 : 0;
  EXPECT_GT(accepted, count / rarity);
}

void expect_one_meaning_of_mit(int count) {
  const MitCommand order{.position = 1, .velocity = 2, .stiffness = 30, .damping = 1, .torque = -3};
  expect_one_meaning_of(check_damiao,
                        {encode_mit(kFuzzNode, kFuzzRanges, order), damiao::encode(kFuzzNode, MitRequest::kEnable),
                         damiao::encode(canid_t{19}, kFuzzRanges, damiao::Feedback{.node = kFuzzNode, .position = 1}),
                         damiao::encode(damiao::kRegisterId, damiao::RegisterAccess{.node = kFuzzNode, .value = 600})},
                        count);
  expect_one_meaning_of(
      check_cybergear,
      {cybergear::encode_order(kFuzzNode, kFuzzRanges, order),
       cybergear::encode_request(cybergear::Type::kEnable, kFuzzNode),
       cybergear::encode(std::uint8_t{cybergear::kHost}, kFuzzRanges, {.node = kFuzzNode, .position = 1}),
       cybergear::encode({.type = cybergear::Type::kRead, .data = cybergear::kHost, .target = kFuzzNode},
                         {.value = 600})},
      count);
  const ak::Reply reply{.node = kFuzzNode, .position = 1, .velocity = 2, .torque = 3};
  ak::Reply healthy = reply;
  healthy.health = {.temperature = 75, .error = ak::Error::kNone};
  expect_one_meaning_of(check_ak, {ak::encode(kFuzzRanges, reply), ak::encode(kFuzzRanges, healthy)}, count);
  const moteus::Reply state{.mode = 10, .position = 1, .velocity = -2, .torque = 3, .voltage = 40, .temperature = 35};
  moteus::Reply details = state;
  details.details = true;
  const moteus::Request stop{.details = true};
  const moteus::Request request{.mode = moteus::Mode::kPosition, .command = order, .max_torque = 20, .timeout = 0.03};
  expect_one_meaning_of(check_moteus,
                        {moteus::encode(kFuzzNode, state), moteus::encode(kFuzzNode, details),
                         moteus::encode(kFuzzNode, kFuzzRanges, stop), moteus::encode(kFuzzNode, kFuzzRanges, request)},
                        count, 10);
}

TEST(CodecFuzz, ODriveFramesHaveOneMeaningOrNone) {
  expect_one_meaning_of_odrives(kFrames);
}

TEST(CodecFuzz, VescFramesHaveOneMeaningOrNone) {
  expect_one_meaning_of_vescs(kFrames);
}

TEST(CodecFuzz, CanopenFramesHaveOneMeaningOrNone) {
  expect_one_meaning_of_canopen(kFrames);
}

TEST(CodecFuzz, MitFramesHaveOneMeaningOrNone) {
  expect_one_meaning_of_mit(kFrames);
}

TEST(CodecFuzz, NightlyAMillionFramesOfEachDialectHaveOneMeaningOrNone) {
  expect_one_meaning_of_odrives(kManyFrames);
  expect_one_meaning_of_vescs(kManyFrames);
  expect_one_meaning_of_canopen(kManyFrames);
  expect_one_meaning_of_mit(kManyFrames);
}

}  // namespace robot_control::tests
