#pragma once
/// The two datagrams of a Unitree Go1 at the low level: a LowCmd goes to the robot, a LowState comes back. The
/// positions of all bytes were measured with the maker's library (PyPI unitree-legged-sdk 3.8.20231105), and so was
/// this:
///
///   layout   little-endian, packed, without gaps: the order of the members here
///   motor    kMotors places, of which a Go1 has the first kRobotMotors: front right, front left, rear right, rear left;
///            each with hip, thigh, calf
///   torques  i16 of 1/256 N·m: the maker's library wraps beyond ±127.99 N·m, `encode` clamps and reports it
///   gains    i16 of 1/32 N·m/rad and of 1/16 N·m·s/rad; `encode` clamps and reports them
///   check    over all 32-bit words before the last `reserve`, which is not covered as a whole: polynomial 04C11DB7,
///            start FFFFFFFF, highest bit of a word first, no final inversion
///
/// A1 and Aliengo (SDK 3.3 and before) pack their messages differently. Their datagrams have another length, which
/// `decode` refuses.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robot_control::unitree {

inline constexpr std::size_t kCommandBytes = 614;
inline constexpr std::size_t kStateBytes = 807;
inline constexpr std::size_t kMotors = 20;
inline constexpr std::size_t kRobotMotors = 12;
inline constexpr std::uint8_t kLowLevel = 0xFF;
inline constexpr float kNoPosition = 2.146e9F;  ///< rad: the motor holds no position
inline constexpr float kNoVelocity = 16000;     ///< rad/s: the motor holds no velocity
inline constexpr double kMaxTorque = 32767 / 256.0;

enum MotorMode : std::uint8_t {
  kDamping = 0x00,
  kServo = 0x0A,  ///< τ = tau + kp (q − q_motor) + kd (dq − q̇_motor)
};

struct MotorCommand {
  std::uint8_t mode = kDamping;
  float q = kNoPosition;   ///< rad
  float dq = kNoVelocity;  ///< rad/s
  double tau = 0;          ///< N·m
  double kp = 0;           ///< N·m/rad
  double kd = 0;           ///< N·m·s/rad
  std::array<std::uint32_t, 3> reserve{};
};

/// Beginning of both messages, after the two bytes FE EF.
struct LegHead {
  std::uint8_t level = kLowLevel;
  std::uint8_t reserve = 0;
  std::array<std::uint32_t, 2> serial_number{};
  std::array<std::uint32_t, 2> version{};
  std::uint16_t band_width = 0;
};

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

struct LegImu {
  std::array<float, 4> quaternion{1, 0, 0, 0};  ///< w, x, y, z
  std::array<float, 3> gyroscope{};             ///< rad/s
  std::array<float, 3> accelerometer{};         ///< m/s², +g upwards at rest
  std::array<float, 3> rpy{};                   ///< rad
  std::int8_t temperature = 0;                  ///< °C
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

/// Returns whether the keys L2 and B of the remote are pressed together, with which the maker's controllers go to
/// their passive state. The two bytes of the keys are those of xKeySwitchUnion (unitree_legged_sdk, joystick.h): R1,
/// L1, start, select, R2, L2, F1, F2, A, B, X, Y, up, right, down, left, from the lowest bit on.
inline bool requests_stop(const std::array<std::uint8_t, 40>& remote) noexcept {
  constexpr std::uint8_t kL2 = 1U << 5U, kB = 1U << 1U;
  return (remote[2] & kL2) != 0 && (remote[3] & kB) != 0;
}

/// Why a datagram is no message.
enum class Flaw : std::uint8_t {
  kNone,
  kLength,
  kHead,   ///< It does not begin with FE EF FF.
  kCheck,  ///< The check sum is wrong.
  kValue,  ///< A number is not finite. In a state also: an angle, velocity or acceleration beyond kMaxNumber, a charge
           ///< above 100 %.
};

inline constexpr float kMaxNumber = 10'000;

/// Returns false if a number had to be clamped, or was NaN, which becomes 0.
bool encode(const LowCmd& command, std::span<std::uint8_t, kCommandBytes> bytes) noexcept;
bool encode(const LowState& state, std::span<std::uint8_t, kStateBytes> bytes) noexcept;

/// Changes the message only if the result is kNone.
Flaw decode(std::span<const std::uint8_t> bytes, LowCmd& command) noexcept;
Flaw decode(std::span<const std::uint8_t> bytes, LowState& state) noexcept;

/// Returns the check sum of the whole words at the beginning of `bytes`.
std::uint32_t check_sum(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace robot_control::unitree
