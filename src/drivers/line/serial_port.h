#pragma once
/// A SerialPort is a SerialLine over a tty: a device of /dev, a link in /dev/serial/by-id, or a pseudo-terminal.
///
/// The tty is opened raw and exclusively: TIOCEXCL, and a lock that also keeps out programs of root. Low latency is
/// requested, because an FTDI adapter otherwise holds bytes for 16 ms. A thread waits for bytes and notes the time of
/// their arrival. It tries again once per kRetry where the device is absent or has disappeared. A device that comes
/// back is found under another number, too. For this, an address outside /dev/serial is replaced by the link in
/// /dev/serial/by-id that leads to it, if there is one.
///
/// The descriptor has the same number for the whole life of the object, so that `send` needs no lock. Without a device
/// it leads to /dev/null.

#include <atomic>
#include <functional>
#include <memory>

#include "drivers/line/serial_line.h"
#include "files/descriptor.h"
#include "rt/realtime_thread.h"

namespace robot_control {

class SerialPort final : public SerialLine {
 public:
  static constexpr int kRetryMs = 100;
  static constexpr const char* kById = "/dev/serial/by-id";

  /// `bit_rate` in bit/s; 0 leaves it as it is, which a USB device ignores. `links` is the folder of the links by id.
  /// `thread` states how the reading thread runs, which calls `clock` for the present time in ns. A device that is
  /// absent is awaited. Throws DriverError if there is one that cannot be used.
  SerialPort(std::string address, unsigned bit_rate, const RealtimeParameters& thread,
             std::function<std::int64_t()> clock, std::string links = kById);
  ~SerialPort() override;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  bool receive(SerialChunk& chunk) noexcept override;
  bool send(std::span<const std::uint8_t> bytes) noexcept override;
  bool connected() const noexcept override { return connected_; }
  std::string name() const override { return address_; }

  /// Returns the number of chunks for which there was no room.
  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  static constexpr std::size_t kChunks = 64;

  bool try_open();
  void disconnect() noexcept;
  void run() noexcept;
  void read_available() noexcept;

  std::string address_;
  unsigned bit_rate_;
  std::function<std::int64_t()> clock_;
  Descriptor file_;
  std::atomic<bool> connected_ = false;
  std::atomic<bool> ending_ = false;
  std::array<SerialChunk, kChunks> chunks_{};
  std::atomic<std::size_t> written_ = 0;  // chunks by the reading thread
  std::atomic<std::size_t> taken_ = 0;    // chunks by the caller of `receive`
  std::atomic<std::uint64_t> dropped_ = 0;
  std::unique_ptr<RealtimeThread> thread_;
};

/// Returns whether a tty can have this bit rate.
bool is_bit_rate(unsigned bit_rate) noexcept;

}  // namespace robot_control
