#pragma once
/// The two messages of a Unitree Go2 or B2 at the low level: a LowCmd goes to the robot, a LowState comes back. They
/// are DDS samples; here they are the bytes of the C structs, which the maker's check sum covers. Source of the
/// members: unitree_go/msg/dds_ of unitree_sdk2_python; the sizes 812 and 1180 are those of its utils/crc.py.
///
///   layout   little-endian, each member at a multiple of its size, gaps 0: the order of the members here
///   °C       an octet of the IDL, and signed in utils/crc.py
///   check    over all words but the last one, which holds it

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/unitree/low_level.h"

namespace robot_control::unitree::go {

inline constexpr std::size_t kCommandBytes = 812;
inline constexpr std::size_t kStateBytes = 1180;
inline constexpr double kMaxTorque = 1000;    ///< N·m, above that of every joint of a B2
inline constexpr std::uint8_t kServo = 0x01;  ///< mode of a motor with a command

struct LowCmd {
  LegHead head;
  std::array<MotorCommand, kMotors> motors{};
  std::array<std::uint8_t, 4> bms{};
  std::array<std::uint8_t, 40> remote{};
  std::array<std::uint8_t, 12> led{};
  std::array<std::uint8_t, 2> fan{};
  std::uint8_t gpio = 0;
  std::uint32_t reserve = 0;
};

struct MotorState {
  std::uint8_t mode = kDamping;
  float q = 0;                  ///< rad
  float dq = 0;                 ///< rad/s
  float ddq = 0;                ///< rad/s²
  double tau = 0;               ///< N·m, estimated by the motor
  float q_raw = 0;              ///< rad
  float dq_raw = 0;             ///< rad/s
  float ddq_raw = 0;            ///< rad/s²
  std::int8_t temperature = 0;  ///< °C
  std::uint32_t lost = 0;       ///< messages that the motor missed
  std::array<std::uint32_t, 2> reserve{};
};

struct Battery {
  std::uint8_t version_high = 0, version_low = 0;
  std::uint8_t status = 0;
  std::uint8_t charge = 0;   ///< %
  std::int32_t current = 0;  ///< mA, negative when discharging
  std::uint16_t cycles = 0;
  std::array<std::int8_t, 2> bq_temperature{}, mcu_temperature{};  ///< °C
  std::array<std::uint16_t, 15> cells{};                           ///< mV
};

struct LowState {
  LegHead head;
  LegImu imu;
  std::array<MotorState, kMotors> motors{};
  Battery battery;
  std::array<std::int16_t, 4> foot_force{};           ///< raw numbers of the sensors, not newton
  std::array<std::int16_t, 4> foot_force_estimate{};  ///< raw
  std::uint32_t tick = 0;                             ///< ms
  std::array<std::uint8_t, 40> remote{};
  std::uint8_t flags = 0;
  float reel = 0;
  std::array<std::int8_t, 2> board_temperature{};  ///< °C
  float voltage = 0;                               ///< V
  float current = 0;                               ///< A
  std::array<std::uint16_t, 4> fans{};             ///< 1/min
  std::uint32_t reserve = 0;
};

/// Returns false if a number was NaN or infinite, which becomes 0.
bool encode(const LowCmd& command, std::span<std::uint8_t, kCommandBytes> bytes) noexcept;
bool encode(const LowState& state, std::span<std::uint8_t, kStateBytes> bytes) noexcept;

/// Changes the message only if the result is kNone.
Flaw decode(std::span<const std::uint8_t> bytes, LowCmd& command) noexcept;
Flaw decode(std::span<const std::uint8_t> bytes, LowState& state) noexcept;

/// Sets the bytes between the members to 0. A DDS library leaves them as they were, and the check sum covers them.
void clear_gaps_of_command(std::span<std::uint8_t, kCommandBytes> bytes) noexcept;
void clear_gaps_of_state(std::span<std::uint8_t, kStateBytes> bytes) noexcept;

}  // namespace robot_control::unitree::go
