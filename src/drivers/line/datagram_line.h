#pragma once
/// A DatagramLine is one end of a line of datagrams between a driver and its device. A datagram arrives whole or not at
/// all. It may be late, twice, out of order or damaged.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace robot_control {

/// Datagrams that a driver takes in one cycle, so that a flooded line does not stop the loop.
inline constexpr int kDatagramsPerCycle = 32;

/// Bytes of the longest datagram.
inline constexpr std::size_t kMaxDatagram = 1536;

class DatagramLine {
 public:
  virtual ~DatagramLine() = default;

  /// Takes the oldest datagram that arrived. Returns its size, of which at most bytes.size() bytes were written; 0:
  /// there is none. Never blocks.
  virtual std::size_t receive(std::span<std::uint8_t> bytes) noexcept = 0;

  /// Hands a datagram to the line. Never blocks. Returns false if the line did not take it.
  virtual bool send(std::span<const std::uint8_t> bytes) noexcept = 0;

  /// Returns the address in words.
  virtual std::string name() const = 0;
};

}  // namespace robot_control
