/// Every layout is compared with the DBC files by tests/drivers/test_can_codecs.py; these tests are for the rest.

#include <gtest/gtest.h>

#include <random>

#include "drivers/odrive/odrive_catalogue.h"
#include "drivers/odrive/odrive_errors.h"

namespace robot_control::odrive::tests {

TEST(ODrive, ATorqueIsFourBytesUnderTheNodesIdentifier) {
  const can_frame frame = encode(3, SetInputTorque{.torque = 1.5});
  EXPECT_EQ(frame.can_id, 0x06Eu);
  EXPECT_EQ(frame.len, 4);
  EXPECT_EQ(data_word(frame), 0x3FC00000u);  // 1.5 in IEEE 754
  EXPECT_EQ(node_of(frame), 3);
}

TEST(ODrive, MessagesOfMoreThanOneByteHaveEight) {
  EXPECT_EQ(encode(0, SetAxisState{}).len, 8);
  EXPECT_EQ(encode(0, v06::ClearErrors{}).len, 1);
  EXPECT_EQ(encode(0, Estop{}).len, 0);
  EXPECT_EQ(encode(0, v05::EncoderError{}).len, 8);
  EXPECT_EQ(encode(0, v06::Heartbeat{}).len, 8);
}

TEST(ODrive, ARequestIsARemoteFrameWithoutDataAndNoMessage) {
  const can_frame frame = request<EncoderEstimates>(5);
  EXPECT_EQ(frame.can_id, 0x0A9u | CAN_RTR_FLAG);
  EXPECT_EQ(frame.len, 0);
  EXPECT_FALSE(decode<EncoderEstimates>(frame));
}

TEST(ODrive, ATurnIsTwoPi) {
  const auto estimates = decode<EncoderEstimates>(word_frame(0x029, 0xC0000000'3F800000, 8));  // −2 turns/s, 1 turn
  ASSERT_TRUE(estimates);
  EXPECT_DOUBLE_EQ(estimates->position, 2 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(estimates->velocity, -4 * std::numbers::pi);
}

TEST(ODrive, OtherFramesAreNotThisMessage) {
  const can_frame good = encode(1, EncoderEstimates{.position = 1, .velocity = 2});
  ASSERT_TRUE(decode<EncoderEstimates>(good));
  for (const canid_t flag : {CAN_EFF_FLAG, CAN_RTR_FLAG, CAN_ERR_FLAG}) {
    can_frame other = good;
    other.can_id |= flag;
    EXPECT_FALSE(decode<EncoderEstimates>(other)) << std::hex << flag;
  }
  can_frame other = good;
  other.can_id ^= 1;
  EXPECT_FALSE(decode<EncoderEstimates>(other));
  other = good;
  other.len = 7;
  EXPECT_FALSE(decode<EncoderEstimates>(other));
  other.len = 9;
  EXPECT_FALSE(decode<EncoderEstimates>(other));
}

TEST(ODrive, TheHighWordOfAMotorErrorIsKept) {
  constexpr std::uint64_t kUnbalancedPhases = 0x8'0000'0000;
  EXPECT_EQ(decode<v05::MotorError>(encode(0, v05::MotorError{.error = kUnbalancedPhases}))->error, kUnbalancedPhases);
}

TEST(ODrive, AHugeNumberIsTheLargestAndNotInfinity) {
  constexpr float kMax = std::numeric_limits<float>::max();
  EXPECT_EQ(data_word(encode(0, SetInputTorque{.torque = 1e300})), std::bit_cast<std::uint32_t>(kMax));
}

TEST(ODrive, ANumberThatIsNotFiniteStaysSo) {
  for (const double number : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto sent = decode<SetInputTorque>(encode(0, SetInputTorque{.torque = number}));
    ASSERT_TRUE(sent);
    EXPECT_FALSE(std::isfinite(sent->torque));
  }
}

TEST(ODrive, UnitsLoseNoBitOfAPosition) {
  std::mt19937 random(1);
  for (int i = 0; i < 100'000; ++i) {
    const auto bits = static_cast<std::uint32_t>(random());
    if (std::isnan(std::bit_cast<float>(bits))) continue;
    const auto estimates = unpacked<EncoderEstimates>(bits);
    ASSERT_EQ(packed(estimates), bits) << std::bit_cast<float>(bits) << " turns";
  }
}

TEST(ODrive, ErrorsHaveNames) {
  EXPECT_EQ(error_names(ErrorKind::kAny06, kWatchdogExpired06 | kEstopRequested06),
            "WATCHDOG_TIMER_EXPIRED ESTOP_REQUESTED");
  EXPECT_EQ(error_names(ErrorKind::kAny06, 0x6000), "MOTOR_OVER_TEMP INVERTER_OVER_TEMP");
  EXPECT_EQ(error_names(ErrorKind::kAny06, kUnderVoltage06), "DC_BUS_UNDER_VOLTAGE");
  EXPECT_EQ(error_names(ErrorKind::kAxis05, kWatchdogExpired05 | kEstopRequested05 | 0x40000),
            "WATCHDOG_TIMER_EXPIRED ESTOP_REQUESTED OVER_TEMP");
  EXPECT_EQ(error_names(ErrorKind::kMotor05, 0x80'0000'0008), "DRV_FAULT 0x8000000000");
  EXPECT_EQ(error_names(ErrorKind::kEncoder05, 0), "NONE");
}

}  // namespace robot_control::odrive::tests
