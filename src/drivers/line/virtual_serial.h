#pragma once
/// A VirtualSerial is a serial line in virtual time with two ends. Each byte needs its time on the line; a message is
/// late by `delay` and up to `jitter`, and never overtakes another. Bytes are lost or damaged with given probabilities.
/// A stalled line keeps what was sent and delivers it when it runs again; of a cut line nothing comes.

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include "drivers/line/answer_faults.h"
#include "drivers/line/serial_line.h"

namespace robot_control {

struct SerialFaults {
  std::int64_t delay_ns = 100'000;
  std::int64_t jitter_ns = 0;
  double message_loss = 0;  ///< probability per message
  double bit_errors = 0;    ///< probability per message of one wrong bit
  double byte_loss = 0;     ///< probability per byte
  bool partial = false;     ///< A message is taken in part, as by a full buffer, one time in ten.
  bool stalled = false;
  bool cut = false;
  AnswerFault answers = AnswerFault::kNone;  ///< of all messages to the driver
};

/// The words of `inject`: lossy (5 % of the messages are lost, 1 % damaged), late (3 ms of jitter), disturbed (both),
/// partial (writes are taken in part). Those of AnswerFault are words, too.
inline constexpr const char* kSerialFaultWords = "ok, lossy, late, disturbed, partial, stalled, cut";

/// Returns nothing for another word.
std::optional<SerialFaults> serial_faults(std::string_view word);

class VirtualSerial {
 public:
  /// `bit_rate` in bit/s; 0: bytes need no time.
  VirtualSerial(double bit_rate, std::uint64_t seed);

  /// The line outlives its ends.
  std::unique_ptr<SerialLine> driver_end() { return std::make_unique<End>(*this, to_driver_, to_device_); }
  SerialLine& device_end() noexcept { return device_end_; }

  void advance(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }
  std::int64_t now_ns() const noexcept { return now_ns_; }
  SerialFaults& faults() noexcept { return faults_; }

 private:
  static constexpr std::size_t kBufferBytes = 4096;  // of an adapter's driver

  struct Byte {
    std::int64_t arrives_ns = 0;
    std::uint8_t value = 0;
  };
  struct Way {
    std::vector<Byte> bytes = std::vector<Byte>(kBufferBytes);  // a ring; what does not fit is lost
    std::size_t written = 0;
    std::size_t taken = 0;
    std::int64_t free_ns = 0;  // when the line has carried the last byte
  };
  class End final : public SerialLine {
   public:
    End(VirtualSerial& line, Way& in, Way& out) : line_(line), in_(in), out_(out) {}
    bool receive(SerialChunk& chunk) noexcept override { return line_.receive(in_, chunk); }
    bool send(std::span<const std::uint8_t> bytes) noexcept override { return line_.send(out_, bytes); }
    bool connected() const noexcept override { return !line_.faults_.cut; }
    std::string name() const override { return "a simulated line"; }

   private:
    VirtualSerial& line_;
    Way& in_;
    Way& out_;
  };

  bool receive(Way& way, SerialChunk& chunk) const noexcept;
  bool send(Way& way, std::span<const std::uint8_t> bytes);
  double chance() { return std::uniform_real_distribution<double>()(random_); }

  std::int64_t byte_ns_;
  std::int64_t now_ns_ = 0;
  SerialFaults faults_;
  std::mt19937_64 random_;
  Way to_device_;
  Way to_driver_;
  End device_end_{*this, to_device_, to_driver_};
};

}  // namespace robot_control
