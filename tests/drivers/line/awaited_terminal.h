#pragma once
/// The driver's port and the device's end of a pseudo-terminal. The driver waits for what is under way to it, so that
/// the load of the machine changes nothing.

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "drivers/line/pseudo_terminal.h"
#include "drivers/line/serial_port.h"

namespace robot_control {

/// Bytes that are under way to the driver.
using UnderWay = std::shared_ptr<std::atomic<std::size_t>>;

/// The device's end, which counts its bytes.
class CountedLine final : public SerialLine {
 public:
  CountedLine(const std::string& path, UnderWay bytes) : line_(path), bytes_(std::move(bytes)) {}
  bool receive(SerialChunk& chunk) noexcept override { return line_.receive(chunk); }
  bool send(std::span<const std::uint8_t> bytes) noexcept override {
    *bytes_ += bytes.size();
    return line_.send(bytes);
  }
  bool connected() const noexcept override { return line_.connected(); }
  std::string name() const override { return line_.name(); }

 private:
  PseudoTerminal line_;
  UnderWay bytes_;
};

/// The driver's port. `receive` takes what `await` waited for.
class AwaitedLine final : public SerialLine {
 public:
  AwaitedLine(const std::string& path, UnderWay bytes)
      : line_(path, 0, {.name = "serial", .policy = RealtimePolicy::kOff}, &latest), bytes_(std::move(bytes)) {}

  /// Waits until bytes that are under way have come, at most 10 s.
  void await() noexcept {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!has_next_ && *bytes_ > 0 && std::chrono::steady_clock::now() < end) {
      has_next_ = line_.receive(next_);
      if (!has_next_) std::this_thread::yield();
    }
  }
  bool receive(SerialChunk& chunk) noexcept override {
    await();
    if (!std::exchange(has_next_, false)) return false;
    chunk = next_;
    *bytes_ -= chunk.size;
    return true;
  }
  bool send(std::span<const std::uint8_t> bytes) noexcept override { return line_.send(bytes); }
  bool connected() const noexcept override { return line_.connected(); }
  std::string name() const override { return line_.name(); }

 private:
  /// The driver takes a later time for its own present one.
  static std::int64_t latest() { return std::numeric_limits<std::int64_t>::max(); }

  SerialPort line_;
  UnderWay bytes_;
  SerialChunk next_;
  bool has_next_ = false;
};

}  // namespace robot_control
