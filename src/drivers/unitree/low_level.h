#pragma once
/// The common part of the low levels of all legged robots of Unitree. It is the command of a motor, the beginning of a
/// message, the IMU, the check sum, and the keys of the remote.
///
/// A message has kMotors places for motors. The legs take the first kRobotMotors: front right, front left, rear right,
/// rear left; each with hip, thigh, calf. The check sum covers whole 32-bit words.
///
///   check sum   polynomial 04C11DB7, start FFFFFFFF, highest bit of a word first, no final inversion

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robot_control::unitree {

inline constexpr std::size_t kMotors = 20;
inline constexpr std::size_t kRobotMotors = 12;
inline constexpr std::uint8_t kLowLevel = 0xFF;
inline constexpr float kNoPosition = 2.146e9F;  ///< rad: the motor holds no position
inline constexpr float kNoVelocity = 16000;     ///< rad/s: the motor holds no velocity
inline constexpr std::uint8_t kDamping = 0x00;  ///< mode of a motor without a command

/// In the mode of a servo: τ = tau + kp (q − q_motor) + kd (dq − q̇_motor).
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

struct LegImu {
  std::array<float, 4> quaternion{1, 0, 0, 0};  ///< w, x, y, z
  std::array<float, 3> gyroscope{};             ///< rad/s
  std::array<float, 3> accelerometer{};         ///< m/s², +g upwards at rest
  std::array<float, 3> rpy{};                   ///< rad
  std::int8_t temperature = 0;                  ///< °C
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
  kHead,   ///< It does not begin as its kind does.
  kCheck,  ///< The check sum is wrong.
  kValue,  ///< A number is not finite. In a state also: an angle, velocity or acceleration beyond kMaxNumber, a charge
           ///< above 100 %.
};

inline constexpr float kMaxNumber = 10'000;

/// Returns the check sum of the whole words at the beginning of `bytes`.
std::uint32_t check_sum(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace robot_control::unitree
