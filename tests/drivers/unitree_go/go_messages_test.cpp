/// The maker's own library is compared by tests/drivers/test_leg_peers_dds.py. Expected positions follow from the order
/// and the sizes of the members in the maker's IDL.

#include "drivers/unitree_go/go_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "drivers/unitree_go/bridge_report.h"
#include "drivers/unitree_go/random_messages.h"

namespace robot_control::unitree::go::tests {

using CommandBytes = std::array<std::uint8_t, kCommandBytes>;
using StateBytes = std::array<std::uint8_t, kStateBytes>;

template <class Value>
Value at(std::span<const std::uint8_t> bytes, std::size_t place) {
  Value value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

CommandBytes encoded(const LowCmd& command) {
  CommandBytes bytes{};
  EXPECT_TRUE(encode(command, bytes));
  return bytes;
}

StateBytes encoded(const LowState& state) {
  StateBytes bytes{};
  EXPECT_TRUE(encode(state, bytes));
  return bytes;
}

TEST(GoLowCmd, ItsMembersLieAsInTheMakersStruct) {
  LowCmd command;
  command.head.serial_number = {1, 2};
  command.head.version = {3, 4};
  command.head.band_width = 5;
  command.motors[2] = {.mode = kServo, .q = 1.5F, .dq = -2, .tau = 3, .kp = 40, .kd = 5, .reserve = {6, 7, 8}};
  command.bms = {9, 0, 0, 0};
  command.remote[39] = 10;
  command.led[11] = 11;
  command.fan[1] = 12;
  command.gpio = 13;
  command.reserve = 14;
  const CommandBytes bytes = encoded(command);
  EXPECT_EQ(at<std::uint32_t>(bytes, 0) & 0xFFFFFFU, 0xFFEFFEU);
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 1U);
  EXPECT_EQ(at<std::uint32_t>(bytes, 16), 4U);
  EXPECT_EQ(at<std::uint16_t>(bytes, 20), 5U);
  constexpr std::size_t kMotor = 24 + 2 * 36;
  EXPECT_EQ(bytes[kMotor], 0x01);
  EXPECT_EQ(at<float>(bytes, kMotor + 4), 1.5F);
  EXPECT_EQ(at<float>(bytes, kMotor + 8), -2);
  EXPECT_EQ(at<float>(bytes, kMotor + 12), 3);
  EXPECT_EQ(at<float>(bytes, kMotor + 16), 40);
  EXPECT_EQ(at<float>(bytes, kMotor + 20), 5);
  EXPECT_EQ(at<std::uint32_t>(bytes, kMotor + 32), 8U);
  EXPECT_EQ(at<float>(bytes, 24 + 4), 2.146e9F) << "a motor without a command";
  EXPECT_EQ(at<float>(bytes, 24 + 8), 16000);
  EXPECT_EQ(bytes[744], 9);
  EXPECT_EQ(bytes[748 + 39], 10);
  EXPECT_EQ(bytes[788 + 11], 11);
  EXPECT_EQ(bytes[801], 12);
  EXPECT_EQ(bytes[802], 13);
  EXPECT_EQ(at<std::uint32_t>(bytes, 804), 14U);
  EXPECT_EQ(at<std::uint32_t>(bytes, 808), check_sum(std::span(bytes).first(808)));
}

TEST(GoLowState, ItsMembersLieAsInTheMakersStruct) {
  LowState state;
  state.imu = {.quaternion = {1, 2, 3, 4}, .gyroscope = {5, 6, 7}, .accelerometer = {8, 9, 10}, .rpy = {11, 12, 13}};
  state.imu.temperature = 14;
  state.motors[3] = {.mode = 1, .q = 2, .dq = 3, .ddq = 4, .tau = -5, .q_raw = 6, .dq_raw = 7, .ddq_raw = 8};
  state.motors[3].temperature = 50;
  state.motors[3].lost = 51;
  state.battery.charge = 80;
  state.battery.current = -1234;
  state.battery.cells[14] = 3900;
  state.foot_force = {1, 2, 3, -4};
  state.tick = 123456;
  state.remote[39] = 10;
  state.voltage = 28.5F;
  state.current = 3;
  state.fans = {1, 2, 3, 4};
  const StateBytes bytes = encoded(state);
  EXPECT_EQ(at<float>(bytes, 24), 1);
  EXPECT_EQ(at<float>(bytes, 40), 5);
  EXPECT_EQ(at<float>(bytes, 52), 8);
  EXPECT_EQ(at<float>(bytes, 64), 11);
  EXPECT_EQ(bytes[76], 14);
  constexpr std::size_t kMotor = 80 + 3 * 48;
  EXPECT_EQ(bytes[kMotor], 1);
  EXPECT_EQ(at<float>(bytes, kMotor + 4), 2);
  EXPECT_EQ(at<float>(bytes, kMotor + 16), -5);
  EXPECT_EQ(at<float>(bytes, kMotor + 28), 8);
  EXPECT_EQ(bytes[kMotor + 32], 50);
  EXPECT_EQ(at<std::uint32_t>(bytes, kMotor + 36), 51U);
  EXPECT_EQ(bytes[1043], 80);
  EXPECT_EQ(at<std::int32_t>(bytes, 1044), -1234);
  EXPECT_EQ(at<std::uint16_t>(bytes, 1054 + 28), 3900);
  EXPECT_EQ(at<std::int16_t>(bytes, 1090), -4);
  EXPECT_EQ(at<std::uint32_t>(bytes, 1100), 123456U);
  EXPECT_EQ(bytes[1104 + 39], 10);
  EXPECT_EQ(at<float>(bytes, 1156), 28.5F);
  EXPECT_EQ(at<float>(bytes, 1160), 3);
  EXPECT_EQ(at<std::uint16_t>(bytes, 1170), 4);
  EXPECT_EQ(at<std::uint32_t>(bytes, 1176), check_sum(std::span(bytes).first(1176)));
}

TEST(GoLowCmd, ANumberThatIsNotFiniteBecomesZeroAndIsReported) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    LowCmd command, read;
    command.motors[0].kd = value;
    CommandBytes bytes{};
    EXPECT_FALSE(encode(command, bytes));
    ASSERT_EQ(decode(bytes, read), Flaw::kNone);
    EXPECT_EQ(read.motors[0].kd, 0);
  }
}

TEST(GoLowState, EachFlawIsNamed) {
  LowState state;
  const StateBytes good = encoded(state);
  EXPECT_EQ(decode(good, state), Flaw::kNone);
  EXPECT_EQ(decode(std::span(good).first(1179), state), Flaw::kLength);
  EXPECT_EQ(decode({}, state), Flaw::kLength);
  for (std::size_t i = 0; i < kStateBytes; ++i) {
    StateBytes bad = good;
    bad[i] ^= 0x10;
    EXPECT_EQ(decode(bad, state), i < 3 ? Flaw::kHead : Flaw::kCheck) << i;
  }
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e5F}) {
    for (const std::size_t place : {24U, 40U, 84U, 88U}) {
      StateBytes bad = good;
      std::memcpy(bad.data() + place, &value, 4);
      seal(bad);
      state.tick = 77;
      EXPECT_EQ(decode(bad, state), Flaw::kValue) << value << " at " << place;
      EXPECT_EQ(state.tick, 77U);
    }
  }
  StateBytes bad = good;
  bad[1043] = 101;
  seal(bad);
  EXPECT_EQ(decode(bad, state), Flaw::kValue);
}

/// A DDS library leaves the gaps of a struct as they were.
TEST(GoMessages, ClearedGapsGiveTheBytesOfTheMessage) {
  RandomMessages random(1);
  const CommandBytes command = encoded(random.command());
  const StateBytes state = encoded(random.state());
  CommandBytes dirty_command{};
  dirty_command.fill(0xAA);
  clear_gaps_of_command(dirty_command);
  StateBytes dirty_state{};
  dirty_state.fill(0xAA);
  clear_gaps_of_state(dirty_state);
  std::size_t gaps = 0;
  for (std::size_t i = 0; i < kCommandBytes; ++i) {
    gaps += dirty_command[i] == 0 ? 1 : 0;
    if (dirty_command[i] == 0) {
      EXPECT_EQ(command[i], 0) << i;
    }
  }
  EXPECT_EQ(gaps, 2 + 20 * 3 + 1U) << "after the band width, each mode and the gpio";
  gaps = 0;
  for (std::size_t i = 0; i < kStateBytes; ++i) {
    gaps += dirty_state[i] == 0 ? 1 : 0;
    if (dirty_state[i] == 0) {
      EXPECT_EQ(state[i], 0) << i;
    }
  }
  EXPECT_EQ(gaps, 2 + 3 + 20 * (3 + 3) + 3 + 2U)
      << "after the band width, the temperature of the IMU, each mode and temperature, the flags and the temperatures";
}

template <class Message, std::size_t kBytes>
void expect_one_meaning(int count, const std::function<Message(RandomMessages&)>& make,
                        const std::function<void(std::span<std::uint8_t, kBytes>)>& clear_gaps) {
  RandomMessages random(74);
  int accepted = 0;
  for (int i = 0; i < count; ++i) {
    std::array<std::uint8_t, kBytes> bytes{};
    ASSERT_TRUE(encode(make(random), bytes)) << i;
    Message message;
    ASSERT_EQ(decode(bytes, message), Flaw::kNone) << i;
    for (auto changes = random.raw() % 4; changes > 0; --changes)
      bytes[random.raw() % kBytes] ^= static_cast<std::uint8_t>(1U << random.raw() % 8);
    clear_gaps(bytes);
    if (random.raw() % 2 == 0) seal(bytes);
    const std::size_t size = random.raw() % 8 == 0 ? random.raw() % kBytes : kBytes;
    if (decode(std::span(bytes).first(size), message) != Flaw::kNone) continue;
    ++accepted;
    std::array<std::uint8_t, kBytes> again{};
    ASSERT_TRUE(encode(message, again)) << i;
    ASSERT_EQ(again, bytes) << i;
  }
  EXPECT_GT(accepted, count / 4);
}

void expect_one_meaning(int count) {
  expect_one_meaning<LowCmd, kCommandBytes>(
      count, [](RandomMessages& random) { return random.command(); }, clear_gaps_of_command);
  expect_one_meaning<LowState, kStateBytes>(
      count, [](RandomMessages& random) { return random.state(); }, clear_gaps_of_state);
}

TEST(GoFuzz, MutantsHaveOneMeaningOrNone) {
  expect_one_meaning(10'000);
}

TEST(GoFuzz, NightlyAMillionMutantsHaveOneMeaningOrNone) {
  expect_one_meaning(1'000'000);
}

TEST(BridgeReport, IsReadAsItWasWrittenAndAnythingElseIsRefused) {
  const BridgeReport report{.process = 7,
                            .writers = 2,
                            .other_commands = 1,
                            .robots = RobotsSeen::kOne,
                            .service = MotionService::kActive,
                            .mode = {'m', 'c', 'f'}};
  std::array<std::uint8_t, kReportBytes> bytes{};
  write_report(report, bytes);
  BridgeReport read;
  ASSERT_TRUE(read_report(bytes, read));
  EXPECT_EQ(read, report);
  EXPECT_FALSE(read_report(std::span(bytes).first(kReportBytes - 1), read));
  for (const std::size_t at : {11U, 12U}) {
    const std::uint8_t before = std::exchange(bytes[at], std::uint8_t{5});
    EXPECT_FALSE(read_report(bytes, read)) << "a word without a meaning";
    bytes[at] = before;
  }
  bytes[0] ^= 1;
  EXPECT_FALSE(read_report(bytes, read));
  EXPECT_EQ(read, report);
}

TEST(BridgeReport, AModeIsPrintableAndEnds) {
  BridgeReport report, read;
  report.mode.fill('\x1B');
  std::array<std::uint8_t, kReportBytes> bytes{};
  write_report(report, bytes);
  ASSERT_TRUE(read_report(bytes, read));
  EXPECT_STREQ(read.mode.data(), "??????????????");
}

}  // namespace robot_control::unitree::go::tests
