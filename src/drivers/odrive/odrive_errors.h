#pragma once
/// Error bits of both firmwares in the words of their maker. Sources: the enumerations of
/// tests/fixtures/odrive-cansimple-*.dbc.

#include <cstdint>
#include <span>
#include <string>

namespace robot_control::odrive {

/// The message that an error came with.
enum class ErrorKind : std::uint8_t { kAxis05, kMotor05, kEncoder05, kController05, kAny06 };

/// Bits with a reaction of the driver: the axis errors of v05::Heartbeat, the errors of v06::Heartbeat and v06::Error.
inline constexpr std::uint32_t kWatchdogExpired05 = 0x800, kWatchdogExpired06 = 0x0100'0000;
inline constexpr std::uint32_t kEstopRequested05 = 0x4000, kEstopRequested06 = 0x0200'0000;
inline constexpr std::uint32_t kUnderVoltage06 = 0x200;

/// Returns the names of the set bits with a blank between them, unknown bits as a hexadecimal number. "NONE" is 0.
std::string error_names(ErrorKind kind, std::uint64_t error);

/// Returns an error of the axis with its details. With 0.5 they are those of motor, encoder and controller. With 0.6
/// the fourth is the disarm reason, and the last one is 1.
std::string error_words(std::uint64_t error, std::span<const std::uint64_t, 5> details);

}  // namespace robot_control::odrive
