#pragma once
/// A SerialLine is one end of a serial line: bytes go in both ways, without borders, late, damaged or not at all.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace robot_control {

/// Bytes that arrived together.
struct SerialChunk {
  std::int64_t time_ns = 0;  ///< of the arrival, on the clock of the driver
  std::size_t size = 0;
  std::array<std::uint8_t, 112> bytes{};

  std::span<const std::uint8_t> received() const noexcept { return {bytes.data(), size}; }
};

/// Chunks that a driver takes in one cycle, so that a flooded line does not stop the loop.
inline constexpr int kMaxChunks = 32;

class SerialLine {
 public:
  virtual ~SerialLine() = default;

  /// Takes the oldest bytes that arrived. Returns false if there are none. Never blocks.
  virtual bool receive(SerialChunk& chunk) noexcept = 0;

  /// Hands the bytes to the line. Never blocks. Returns false if the line did not take all of them.
  virtual bool send(std::span<const std::uint8_t> bytes) noexcept = 0;

  /// Returns whether there is a device at the other end, as far as this end knows.
  virtual bool connected() const noexcept = 0;

  /// Returns the address in words.
  virtual std::string name() const = 0;
};

}  // namespace robot_control
