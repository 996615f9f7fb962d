#pragma once
/// Packets of a RoboClaw motor controller (packet serial of its maker's manual; PyPI basicmicro 2.0).
///
/// A request is address, command, data, all numbers big-endian. One that writes ends with the CRC of all its bytes and
/// is answered by kAcknowledged. One that reads has neither data nor CRC; its answer is data and the CRC of request and
/// data. The board discards the begin of a request after a pause of kPacketNs.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robot_control::roboclaw {

inline constexpr std::uint8_t kAcknowledged = 0xFF;
inline constexpr std::int64_t kPacketNs = 10'000'000;

enum class PacketCommand : std::uint8_t {
  kSetTimeout = 14,    ///< u8, 100 ms; 0: none
  kGetTimeout = 15,    ///< u8
  kVersion = 21,       ///< text that ends with "\n\0"
  kBattery = 24,       ///< u16, 0.1 V
  kDuties = 34,        ///< i16 of each motor, 1/32767 of the supply
  kSpeeds = 37,        ///< i32 of each motor, counts per s
  kVelocityPid1 = 55,  ///< u32 P, I, D in 1/65536, u32 QPPS: counts per s at full power
  kVelocityPid2 = 56,
  kEncoders = 78,     ///< u32 of each motor
  kTemperature = 82,  ///< u16, 0.1 °C
  kStatus = 90,       ///< u32, errors in the low half; u16 of older firmware
};

/// Returns the bytes of the answer to a request, without its CRC; kAcknowledged counts as none.
constexpr std::size_t answer_size(PacketCommand command) noexcept {
  switch (command) {
    case PacketCommand::kGetTimeout:
      return 1;
    case PacketCommand::kBattery:
    case PacketCommand::kTemperature:
      return 2;
    case PacketCommand::kStatus:
      return 4;
    case PacketCommand::kEncoders:
      return 8;
    case PacketCommand::kVelocityPid1:
    case PacketCommand::kVelocityPid2:
      return 16;
    default:
      return 0;
  }
}

/// Returns the bytes of a request's data.
constexpr std::size_t data_size(PacketCommand command) noexcept {
  switch (command) {
    case PacketCommand::kSetTimeout:
      return 1;
    case PacketCommand::kDuties:
      return 4;
    case PacketCommand::kSpeeds:
      return 8;
    default:
      return 0;
  }
}

constexpr bool is_write(PacketCommand command) noexcept {
  return data_size(command) > 0;
}

/// CRC-16 with the polynomial 0x1021, from 0 or the CRC of what stands before.
constexpr std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc = 0) noexcept {
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte << 8U);
    for (int bit = 0; bit < 8; ++bit)
      crc = static_cast<std::uint16_t>((crc & 0x8000U) != 0 ? crc << 1U ^ 0x1021U : crc << 1U);
  }
  return crc;
}

/// The bytes of a request or an answer.
class Packet {
 public:
  static constexpr std::size_t kMaxSize = 64;

  void add(std::uint64_t value, std::size_t bytes) noexcept {
    for (std::size_t i = 0; i < bytes && size_ < kMaxSize; ++i)
      bytes_[size_++] = static_cast<std::uint8_t>(value >> (8 * (bytes - 1 - i)));
  }
  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  std::span<const std::uint8_t> bytes() const noexcept { return {bytes_.data(), size_}; }

  /// Returns the number at this place, which the caller knows to be inside.
  std::uint32_t number(std::size_t at, std::size_t bytes) const noexcept {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8U | bytes_[at + i];
    return value;
  }

 private:
  std::array<std::uint8_t, kMaxSize> bytes_{};
  std::size_t size_ = 0;
};

/// Returns a request. `first` and `second` are its data of equal size; kSetTimeout has the first alone.
inline Packet request(std::uint8_t address, PacketCommand command, std::int32_t first = 0,
                      std::int32_t second = 0) noexcept {
  Packet packet;
  packet.add(address, 1);
  packet.add(static_cast<std::uint8_t>(command), 1);
  if (!is_write(command)) return packet;
  const std::size_t each = command == PacketCommand::kSetTimeout ? 1 : data_size(command) / 2;
  packet.add(static_cast<std::uint32_t>(first), each);
  if (command != PacketCommand::kSetTimeout) packet.add(static_cast<std::uint32_t>(second), each);
  packet.add(crc16(packet.bytes()), 2);
  return packet;
}

/// Returns whether `received` is an answer with so many bytes of data and the right CRC.
inline bool is_answer(const Packet& asked, const Packet& received, std::size_t size) noexcept {
  if (received.size() != size + 2) return false;
  return crc16(received.bytes().first(size), crc16(asked.bytes())) == received.number(size, 2);
}

}  // namespace robot_control::roboclaw
