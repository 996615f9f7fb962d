#pragma once
/// The two datagrams of a Unitree Go1 at the low level: a LowCmd goes to the robot, a LowState comes back. The
/// positions of all bytes were measured with the maker's library (PyPI unitree-legged-sdk 3.8.20231105), and so was
/// this:
///
///   layout   little-endian, packed, without gaps: the order of the members here
///   torques  i16 of 1/256 N·m: the maker's library wraps beyond ±127.99 N·m, `encode` clamps and reports it
///   gains    i16 of 1/32 N·m/rad and of 1/16 N·m·s/rad; `encode` clamps and reports them
///   check    over all 32-bit words before the last `reserve`, which is not covered as a whole
///
/// A1 and Aliengo (SDK 3.3 and before) pack their messages differently. Their datagrams have another length, which
/// `decode` refuses.

#include "drivers/unitree/low_level.h"

namespace robot_control::unitree {

inline constexpr std::size_t kCommandBytes = 614;
inline constexpr std::size_t kStateBytes = 807;
inline constexpr double kMaxTorque = 32767 / 256.0;
inline constexpr std::uint8_t kServo = 0x0A;  ///< mode of a motor with a command

struct LowCmd {
  LegHead head;
  std::array<MotorCommand, kMotors> motors{};
  std::array<std::uint8_t, 4> bms{};  ///< the first byte A5 switches the battery off
  std::array<std::uint8_t, 40> remote{};
  std::uint32_t reserve = 0;
};

struct MotorState {
  std::uint8_t mode = kDamping;
  float q = 0;                  ///< rad
  float dq = 0;                 ///< rad/s
  std::int16_t ddq = 0;         ///< rad/s²
  double tau = 0;               ///< N·m, estimated by the motor
  float q_raw = 0;              ///< rad
  float dq_raw = 0;             ///< rad/s
  std::int16_t ddq_raw = 0;     ///< rad/s²
  std::int8_t temperature = 0;  ///< °C
  std::array<std::uint32_t, 2> reserve{};
};

struct LegBattery {
  std::uint8_t version_high = 0, version_low = 0;
  std::uint8_t status = 0;
  std::uint8_t charge = 0;   ///< %
  std::int32_t current = 0;  ///< mA, negative when discharging
  std::uint16_t cycles = 0;
  std::array<std::int8_t, 2> bq_temperature{}, mcu_temperature{};  ///< °C
  std::array<std::uint8_t, 10> cells{};                            ///< units of kCellVoltage; 0: no cell
};

inline constexpr double kCellVoltage = 0.032;  ///< V, measured with the maker's library

struct LowState {
  LegHead head;
  LegImu imu;
  std::array<MotorState, kMotors> motors{};
  LegBattery battery;
  std::array<std::int16_t, 4> foot_force{};           ///< raw numbers of the sensors, not newton
  std::array<std::int16_t, 4> foot_force_estimate{};  ///< raw
  std::uint32_t tick = 0;                             ///< counts up; its unit is not used
  std::array<std::uint8_t, 40> remote{};
  std::uint32_t reserve = 0;
};

/// Returns false if a number had to be clamped, or was NaN, which becomes 0.
bool encode(const LowCmd& command, std::span<std::uint8_t, kCommandBytes> bytes) noexcept;
bool encode(const LowState& state, std::span<std::uint8_t, kStateBytes> bytes) noexcept;

/// Changes the message only if the result is kNone.
Flaw decode(std::span<const std::uint8_t> bytes, LowCmd& command) noexcept;
Flaw decode(std::span<const std::uint8_t> bytes, LowState& state) noexcept;

}  // namespace robot_control::unitree
