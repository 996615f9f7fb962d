/// The maker's own library is compared by tests/drivers/test_leg_peers_udp.py. Expected positions are those of the
/// header.

#include "drivers/unitree_legged/legged_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "drivers/unitree_legged/random_messages.h"

namespace robot_control::unitree::tests {

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

/// Gives the bytes a right check sum again.
template <class Bytes>
Bytes checked(Bytes bytes) {
  const std::uint32_t sum = check_sum(std::span(bytes).first(bytes.size() - 4));
  std::memcpy(bytes.data() + bytes.size() - 4, &sum, 4);
  return bytes;
}

TEST(LowCmd, ItsMembersLieWhereTheMakersLibraryPutsThem) {
  LowCmd command;
  command.head.serial_number = {1, 2};
  command.head.version = {3, 4};
  command.head.band_width = 5;
  command.motors[2] = {.mode = kServo, .q = 1.5F, .dq = -2, .tau = 3, .kp = 40, .kd = 5, .reserve = {6, 7, 8}};
  command.bms = {9, 0, 0, 0};
  command.remote[39] = 10;
  command.reserve = 11;
  const CommandBytes bytes = encoded(command);
  EXPECT_EQ(at<std::uint32_t>(bytes, 0) & 0xFFFFFFU, 0xFFEFFEU);
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 1U);
  EXPECT_EQ(at<std::uint32_t>(bytes, 16), 4U);
  EXPECT_EQ(at<std::uint16_t>(bytes, 20), 5U);
  constexpr std::size_t kMotor = 22 + 2 * 27;
  EXPECT_EQ(bytes[kMotor], 0x0A);
  EXPECT_EQ(at<float>(bytes, kMotor + 1), 1.5F);
  EXPECT_EQ(at<float>(bytes, kMotor + 5), -2);
  EXPECT_EQ(at<std::int16_t>(bytes, kMotor + 9), 3 * 256);
  EXPECT_EQ(at<std::int16_t>(bytes, kMotor + 11), 40 * 32);
  EXPECT_EQ(at<std::int16_t>(bytes, kMotor + 13), 5 * 16);
  EXPECT_EQ(at<std::uint32_t>(bytes, kMotor + 23), 8U);
  EXPECT_EQ(at<float>(bytes, 22 + 1), 2.146e9F) << "a motor without a command";
  EXPECT_EQ(at<float>(bytes, 22 + 5), 16000);
  EXPECT_EQ(bytes[562], 9);
  EXPECT_EQ(bytes[566 + 39], 10);
  EXPECT_EQ(at<std::uint32_t>(bytes, 606), 11U);
  EXPECT_EQ(at<std::uint32_t>(bytes, 610), check_sum(std::span(bytes).first(608)));
}

TEST(LowState, ItsMembersLieWhereTheMakersLibraryReadsThem) {
  LowState state;
  state.imu = {.quaternion = {1, 2, 3, 4}, .gyroscope = {5, 6, 7}, .accelerometer = {8, 9, 10}, .rpy = {11, 12, 13}};
  state.imu.temperature = -14;
  state.motors[3] = {.mode = 1, .q = 2, .dq = 3, .ddq = 4, .tau = -5, .q_raw = 6, .dq_raw = 7, .ddq_raw = 8};
  state.motors[3].temperature = 50;
  state.battery.charge = 80;
  state.battery.current = -1234;
  state.battery.cells[9] = 120;
  state.foot_force = {1, 2, 3, -4};
  state.tick = 123456;
  state.remote[39] = 10;
  const StateBytes bytes = encoded(state);
  EXPECT_EQ(at<float>(bytes, 22), 1);
  EXPECT_EQ(at<float>(bytes, 38), 5);
  EXPECT_EQ(at<float>(bytes, 50), 8);
  EXPECT_EQ(at<float>(bytes, 62), 11);
  EXPECT_EQ(at<std::int8_t>(bytes, 74), -14);
  constexpr std::size_t kMotor = 75 + 3 * 32;
  EXPECT_EQ(bytes[kMotor], 1);
  EXPECT_EQ(at<float>(bytes, kMotor + 1), 2);
  EXPECT_EQ(at<float>(bytes, kMotor + 5), 3);
  EXPECT_EQ(at<std::int16_t>(bytes, kMotor + 9), 4);
  EXPECT_EQ(at<std::int16_t>(bytes, kMotor + 11), -5 * 256);
  EXPECT_EQ(at<float>(bytes, kMotor + 13), 6);
  EXPECT_EQ(at<std::int8_t>(bytes, kMotor + 23), 50);
  EXPECT_EQ(bytes[718], 80);
  EXPECT_EQ(at<std::int32_t>(bytes, 719), -1234);
  EXPECT_EQ(bytes[738], 120);
  EXPECT_EQ(at<std::int16_t>(bytes, 745), -4);
  EXPECT_EQ(at<std::uint32_t>(bytes, 755), 123456U);
  EXPECT_EQ(bytes[798], 10);
  EXPECT_EQ(at<std::uint32_t>(bytes, 803), check_sum(std::span(bytes).first(800)));
}

/// The empty low-level command as the maker's library sends it: measured.
TEST(LowCmd, TheCheckSumIsThatOfTheMakersLibrary) {
  LowCmd command;
  for (MotorCommand& motor : command.motors) motor.mode = 0x0A;
  command.head.band_width = 0;
  EXPECT_EQ(at<std::uint32_t>(encoded(command), 610), 0x347FF0E2U);
}

TEST(LowCmd, ATorqueBeyondTheRangeIsClampedAndReported) {
  for (const double torque : {128.5, 200.0, 1e300, std::numeric_limits<double>::infinity()}) {
    for (const double sign : {-1.0, 1.0}) {
      LowCmd command, read;
      command.motors[0].tau = sign * torque;
      CommandBytes bytes{};
      EXPECT_FALSE(encode(command, bytes));
      ASSERT_EQ(decode(bytes, read), Flaw::kNone);
      EXPECT_NEAR(read.motors[0].tau, sign * kMaxTorque, 1.0 / 256) << torque;
    }
  }
  LowCmd command, read;
  command.motors[0].kd = std::numeric_limits<double>::quiet_NaN();
  CommandBytes bytes{};
  EXPECT_FALSE(encode(command, bytes));
  ASSERT_EQ(decode(bytes, read), Flaw::kNone);
  EXPECT_EQ(read.motors[0].kd, 0);
}

TEST(LowState, EachFlawIsNamed) {
  LowState state;
  const StateBytes good = encoded(state);
  EXPECT_EQ(decode(good, state), Flaw::kNone);
  EXPECT_EQ(decode(std::span(good).first(806), state), Flaw::kLength);
  EXPECT_EQ(decode(std::span(good).first(771), state), Flaw::kLength);
  EXPECT_EQ(decode({}, state), Flaw::kLength);
  for (std::size_t i = 0; i < kStateBytes; ++i) {
    StateBytes bad = good;
    bad[i] ^= 0x10;
    const bool covered = i < 800 || i >= 803;
    EXPECT_EQ(decode(bad, state), i < 3 ? Flaw::kHead : covered ? Flaw::kCheck : Flaw::kNone) << i;
  }
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e5F}) {
    for (const std::size_t place : {22U, 38U, 76U, 80U}) {
      StateBytes bad = good;
      std::memcpy(bad.data() + place, &value, 4);
      state.tick = 77;
      EXPECT_EQ(decode(checked(bad), state), Flaw::kValue) << value << " at " << place;
      EXPECT_EQ(state.tick, 77U);
    }
  }
  StateBytes bad = good;
  bad[718] = 101;
  EXPECT_EQ(decode(checked(bad), state), Flaw::kValue);
}

TEST(LowState, TheRemoteRequestsAStopWithL2AndBTogether) {
  std::array<std::uint8_t, 40> remote{};
  EXPECT_FALSE(requests_stop(remote));
  remote[2] = 0x20;
  EXPECT_FALSE(requests_stop(remote));
  remote[3] = 0x02;
  EXPECT_TRUE(requests_stop(remote));
  remote[2] = 0xDF;
  EXPECT_FALSE(requests_stop(remote));
}

template <class Message, std::size_t kBytes>
void expect_one_meaning(int count, const std::function<Message(RandomMessages&)>& make) {
  RandomMessages random(74);
  int accepted = 0;
  for (int i = 0; i < count; ++i) {
    std::array<std::uint8_t, kBytes> bytes{};
    ASSERT_TRUE(encode(make(random), bytes)) << i;
    Message message;
    ASSERT_EQ(decode(bytes, message), Flaw::kNone) << i;
    for (auto changes = random.raw() % 4; changes > 0; --changes)
      bytes[random.raw() % kBytes] ^= static_cast<std::uint8_t>(1U << random.raw() % 8);
    if (random.raw() % 2 == 0) bytes = checked(bytes);
    const std::size_t size = random.raw() % 8 == 0 ? random.raw() % kBytes : kBytes;
    if (decode(std::span(bytes).first(size), message) != Flaw::kNone) continue;
    ++accepted;
    std::array<std::uint8_t, kBytes> again{};
    ASSERT_TRUE(encode(message, again)) << i;
    ASSERT_EQ(again, bytes) << i;
  }
  EXPECT_GT(accepted, count / 4);
}

constexpr int kMutants = 10'000;

TEST(LeggedFuzz, MutantsHaveOneMeaningOrNone) {
  expect_one_meaning<LowCmd, kCommandBytes>(kMutants, [](RandomMessages& random) { return random.command(); });
  expect_one_meaning<LowState, kStateBytes>(kMutants, [](RandomMessages& random) { return random.state(); });
}

TEST(LeggedFuzz, NightlyAMillionMutantsHaveOneMeaningOrNone) {
  expect_one_meaning<LowCmd, kCommandBytes>(1'000'000, [](RandomMessages& random) { return random.command(); });
  expect_one_meaning<LowState, kStateBytes>(1'000'000, [](RandomMessages& random) { return random.state(); });
}

}  // namespace robot_control::unitree::tests
