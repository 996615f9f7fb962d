#pragma once
/// Messages that the firmware 0.6 alone has, or has in another layout than 0.5.

#include "drivers/odrive/odrive_messages.h"

namespace robot_control::odrive::v06 {

/// A drive that does not answer a request for this message has the firmware 0.5.
struct Version {
  static constexpr Command kCommand = from_axis(0x00);
  std::uint8_t protocol = 0;
  std::uint8_t hardware_major = 0;
  std::uint8_t hardware_minor = 0;
  std::uint8_t hardware_variant = 0;
  std::uint8_t firmware_major = 0;
  std::uint8_t firmware_minor = 0;
  std::uint8_t firmware_revision = 0;
  std::uint8_t unreleased = 0;

  static constexpr auto layout() {
    return std::tuple{
        wire_unsigned(&Version::protocol, 0, 8),           wire_unsigned(&Version::hardware_major, 8, 8),
        wire_unsigned(&Version::hardware_minor, 16, 8),    wire_unsigned(&Version::hardware_variant, 24, 8),
        wire_unsigned(&Version::firmware_major, 32, 8),    wire_unsigned(&Version::firmware_minor, 40, 8),
        wire_unsigned(&Version::firmware_revision, 48, 8), wire_unsigned(&Version::unreleased, 56, 8)};
  }
};

struct Heartbeat {
  static constexpr Command kCommand = from_axis(0x01);
  std::uint32_t error = 0;  ///< bits of odrive_errors.h
  AxisState state = AxisState::kUndefined;
  std::uint8_t procedure_result = 0;
  bool trajectory_done = false;

  static constexpr auto layout() {
    return std::tuple{wire_unsigned(&Heartbeat::error, 0, 32), wire_unsigned(&Heartbeat::state, 32, 8),
                      wire_unsigned(&Heartbeat::procedure_result, 40, 8),
                      wire_unsigned(&Heartbeat::trajectory_done, 48, 1)};
  }
};

struct Error {
  static constexpr Command kCommand = from_axis(0x03);
  std::uint32_t active = 0;         ///< bits of odrive_errors.h
  std::uint32_t disarm_reason = 0;  ///< likewise

  static constexpr auto layout() {
    return std::tuple{wire_unsigned(&Error::active, 0, 32), wire_unsigned(&Error::disarm_reason, 32, 32)};
  }
};

/// Reads or writes an endpoint, whose number and type stand in the endpoint list of that exact firmware.
struct RxSdo {
  static constexpr Command kCommand = to_axis(0x04);
  static constexpr std::uint8_t kRead = 0, kWrite = 1;
  std::uint8_t opcode = kRead;
  std::uint16_t endpoint = 0;
  std::uint32_t value = 0;  ///< the bytes of a value of any type, the first one lowest

  static constexpr auto layout() {
    return std::tuple{wire_unsigned(&RxSdo::opcode, 0, 8), wire_unsigned(&RxSdo::endpoint, 8, 16),
                      wire_unsigned(&RxSdo::value, 32, 32)};
  }
};

struct TxSdo {
  static constexpr Command kCommand = from_axis(0x05);
  std::uint16_t endpoint = 0;
  std::uint32_t value = 0;

  static constexpr auto layout() {
    return std::tuple{wire_unsigned(&TxSdo::endpoint, 8, 16), wire_unsigned(&TxSdo::value, 32, 32)};
  }
};

/// Two answers with different serial numbers are two drives of one node number. Sent to a drive, it sets the node of
/// the drive with this serial number.
struct Address {
  static constexpr Command kCommand = from_axis(0x06);
  std::uint8_t node = 0;
  std::uint64_t serial_number = 0;  ///< 48 bits

  static constexpr auto layout() {
    return std::tuple{wire_unsigned(&Address::node, 0, 8), wire_unsigned(&Address::serial_number, 8, 48)};
  }
};

struct Temperature {
  static constexpr Command kCommand = from_axis(0x15);
  double transistors = 0;  ///< °C
  double motor = 0;        ///< °C

  static constexpr auto layout() {
    return std::tuple{wire_float(&Temperature::transistors, 0), wire_float(&Temperature::motor, 32)};
  }
};

struct ClearErrors {
  static constexpr Command kCommand = to_axis(0x18);
  std::uint8_t identify = 0;  ///< 1: the drive blinks

  static constexpr auto layout() { return std::tuple{wire_unsigned(&ClearErrors::identify, 0, 8)}; }
};

struct SetAbsolutePosition {
  static constexpr Command kCommand = to_axis(0x19);
  double position = 0;  ///< rad

  static constexpr auto layout() { return std::tuple{wire_float(&SetAbsolutePosition::position, 0, kTurn)}; }
};

struct Torques {
  static constexpr Command kCommand = from_axis(0x1C);
  double target = 0;    ///< N·m
  double estimate = 0;  ///< N·m

  static constexpr auto layout() {
    return std::tuple{wire_float(&Torques::target, 0), wire_float(&Torques::estimate, 32)};
  }
};

}  // namespace robot_control::odrive::v06
