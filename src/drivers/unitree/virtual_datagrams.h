#pragma once
/// VirtualDatagrams are a line of datagrams in virtual time with two ends. Each datagram arrives after `delay` and up
/// to `jitter`, so that one may overtake another, or is lost or damaged.

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include "drivers/line/answer_faults.h"
#include "drivers/line/datagram_line.h"

namespace robot_control {

struct DatagramFaults {
  std::int64_t delay_ns = 100'000;
  std::int64_t jitter_ns = 0;
  double loss = 0;                           ///< probability per datagram
  bool cut = false;                          ///< Nothing comes.
  AnswerFault answers = AnswerFault::kNone;  ///< of all datagrams to the driver
};

/// The words of `inject`: lossy (5 % are lost), late (2 ms of jitter), disturbed (both), cut. Those of AnswerFault are
/// words, too.
inline constexpr const char* kDatagramFaultWords = "ok, lossy, late, disturbed, cut";

/// Returns nothing for another word.
std::optional<DatagramFaults> datagram_faults(std::string_view word);

class VirtualDatagrams {
 public:
  explicit VirtualDatagrams(std::uint64_t seed) : random_(seed) {}

  /// The line outlives its ends.
  std::unique_ptr<DatagramLine> driver_end() { return std::make_unique<End>(*this, to_driver_, to_device_); }
  DatagramLine& device_end() noexcept { return device_end_; }

  void advance(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }
  DatagramFaults& faults() noexcept { return faults_; }

 private:
  struct Datagram {
    std::int64_t arrives_ns = 0;
    std::size_t size = 0;  // 0: a free place
    std::array<std::uint8_t, kMaxDatagram> bytes{};
  };
  using Way = std::vector<Datagram>;
  static constexpr std::size_t kPlaces = 2048;  // those of a line that is late by 1 s; what does not fit is lost

  class End final : public DatagramLine {
   public:
    End(VirtualDatagrams& line, Way& in, Way& out) : line_(line), in_(in), out_(out) {}
    std::size_t receive(std::span<std::uint8_t> bytes) noexcept override { return line_.receive(in_, bytes); }
    bool send(std::span<const std::uint8_t> bytes) noexcept override { return line_.send(out_, bytes); }
    std::string name() const override { return "a simulated network"; }

   private:
    VirtualDatagrams& line_;
    Way& in_;
    Way& out_;
  };

  std::size_t receive(Way& way, std::span<std::uint8_t> bytes) const noexcept;
  bool send(Way& way, std::span<const std::uint8_t> bytes);
  double chance() { return std::uniform_real_distribution<double>()(random_); }

  std::int64_t now_ns_ = 0;
  DatagramFaults faults_;
  std::mt19937_64 random_;
  Way to_device_ = Way(kPlaces);
  Way to_driver_ = Way(kPlaces);
  End device_end_{*this, to_device_, to_driver_};
};

}  // namespace robot_control
