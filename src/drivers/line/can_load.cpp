#include "drivers/line/can_load.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "signals/formatted_text.h"

namespace robot_control {
namespace {

constexpr unsigned kMaxEqualBits = 5;          // after which a stuff bit follows
constexpr std::uint32_t kPolynomial = 0x4599;  // CRC-15 of CAN, without its highest bit

constexpr std::uint32_t next_crc(std::uint32_t crc, bool bit) noexcept {
  const bool divide = bit != ((crc & 0x4000U) != 0);
  return (crc << 1U & 0x7FFFU) ^ (divide ? kPolynomial : 0);
}

/// The last bit on the bus, and how many bits were equal to it.
struct Run {
  bool bit = true;  // the idle bus is recessive
  unsigned equal = 0;

  /// Returns the number of bits on the bus, of which one may be stuffed.
  constexpr unsigned add(bool next) noexcept {
    equal = next == bit ? equal + 1 : 1;
    bit = next;
    if (equal < kMaxEqualBits) return 1;
    bit = !bit;
    equal = 1;
    return 2;
  }
};

/// The tables hold the effect of one byte on the checksum, on the run, and on the number of bits.
struct ByteTables {
  std::array<std::uint32_t, 256> crc{};
  std::array<std::array<Run, 256>, 2 * kMaxEqualBits> run{};
  std::array<std::array<unsigned, 256>, 2 * kMaxEqualBits> bits{};

  static constexpr std::size_t row(const Run& run) noexcept { return std::size_t{2} * run.equal + (run.bit ? 1U : 0U); }
  constexpr ByteTables() noexcept {
    for (unsigned byte = 0; byte < 256; ++byte) {
      for (unsigned bit = 8; bit-- > 0;) crc[byte] = next_crc(crc[byte], (byte >> bit & 1U) != 0);
      for (unsigned equal = 0; equal < kMaxEqualBits; ++equal) {
        for (const bool last : {false, true}) {
          Run now{.bit = last, .equal = equal};
          const std::size_t from = row(now);
          for (unsigned bit = 8; bit-- > 0;) bits[from][byte] += now.add((byte >> bit & 1U) != 0);
          run[from][byte] = now;
        }
      }
    }
  }
};
constexpr ByteTables kBytes;

/// Counts the bits of a frame as they pass, with those that are stuffed, and computes the checksum.
class BitCounter {
 public:
  void add(std::uint32_t value, unsigned bits) noexcept {
    while (bits >= 8) {
      bits -= 8;
      add_byte(value >> bits & 0xFFU);
    }
    while (bits-- > 0) {
      const bool bit = (value >> bits & 1U) != 0;
      crc_ = next_crc(crc_, bit);
      count_ += run_.add(bit);
    }
  }

  /// The number of all bits so far.
  unsigned count() const noexcept { return count_; }

  /// The number of all bits up to the end of the checksum of a classic frame, which is sent, too.
  unsigned finish() noexcept {
    const std::uint32_t crc = crc_;
    add(crc, 15);
    return count_;
  }

 private:
  void add_byte(std::uint32_t byte) noexcept {
    crc_ = (crc_ << 8U & 0x7FFFU) ^ kBytes.crc[(crc_ >> 7U ^ byte) & 0xFFU];
    const std::size_t from = ByteTables::row(run_);
    count_ += kBytes.bits[from][byte];
    run_ = kBytes.run[from][byte];
  }

  std::uint32_t crc_ = 0;
  unsigned count_ = 0;
  Run run_;
};

/// Adds the bits from the start of frame to the one that marks a remote request.
void add_identifier(BitCounter& counter, const can_frame& frame, bool remote) noexcept {
  counter.add(0, 1);  // start of frame
  if (is_extended(frame)) {
    counter.add(frame.can_id >> 18U & CAN_SFF_MASK, 11);
    counter.add(3, 2);  // SRR and IDE, recessive
    counter.add(frame.can_id & 0x3FFFFU, 18);
  } else {
    counter.add(frame.can_id & CAN_SFF_MASK, 11);
  }
  counter.add(remote ? 1 : 0, 1);
}

struct Bits {
  double per_cycle = 0, per_second = 0;
};

Bits bits_of(std::span<const PlannedFrames> plan, double bit_rate, double data_rate) noexcept {
  Bits sum;
  for (const PlannedFrames& frames : plan) {
    const double bits = frames.fd ? max_fd_bits(frames.extended, frames.data_bytes).weighted(bit_rate, data_rate)
                                  : max_frame_bits(frames.extended, frames.data_bytes);
    sum.per_cycle += bits * frames.per_cycle;
    sum.per_second += bits * frames.per_second;
  }
  return sum;
}

}  // namespace

unsigned frame_bits(const can_frame& frame) noexcept {
  const bool remote = is_remote_request(frame);
  BitCounter counter;
  add_identifier(counter, frame, remote);
  counter.add(0, 2);  // reserved; of 11 bits IDE and a reserved one
  const std::uint8_t length = std::min<std::uint8_t>(frame.len, CAN_MAX_DLEN);
  counter.add(length, 4);
  for (std::uint8_t i = 0; i < length && !remote; ++i) counter.add(frame.data[i], 8);
  return counter.finish() + 13;
}

FrameBits fd_frame_bits(const can_frame& frame) noexcept {
  BitCounter counter;
  add_identifier(counter, frame, false);
  if (!is_extended(frame)) counter.add(0, 1);  // IDE
  const bool switches = (frame.flags & CANFD_BRS) != 0;
  counter.add(switches ? 5 : 4, 3);  // FDF, reserved, BRS
  const unsigned head = counter.count();
  const unsigned length = std::min<unsigned>(frame.len, CANFD_MAX_DLEN);
  const unsigned code = length <= 8 ? length : length <= 24 ? 6 + length / 4 : 11 + length / 16;  // of 4 bits
  counter.add(code, 5);                                                                           // ESI before it
  for (unsigned i = 0; i < length; ++i) counter.add(frame.data[i], 8);
  const unsigned data = counter.count() - head + (length > 16 ? 32 : 27);
  return switches ? FrameBits{.arbitration = head + 13, .data = data} : FrameBits{.arbitration = head + data + 13};
}

double bus_load(std::span<const PlannedFrames> plan, double rate, double bit_rate, double data_rate) noexcept {
  const Bits bits = bits_of(plan, bit_rate, data_rate);
  return (bits.per_cycle * rate + bits.per_second) / bit_rate;
}

std::optional<std::string> bus_load_problem(std::span<const PlannedFrames> plan, double rate, double bit_rate,
                                            double min_rate, double max_load, double data_rate) {
  const double load = bus_load(plan, rate, bit_rate, data_rate);
  if (load <= max_load) return std::nullopt;
  const Bits bits = bits_of(plan, bit_rate, data_rate);
  const double fits = bits.per_cycle > 0 ? std::floor((max_load * bit_rate - bits.per_second) / bits.per_cycle) : 0;
  const std::string problem = formatted(
      "the planned frames load the bus with %.0f %% of %.0f kbit/s at a robot.rate of %g Hz, more than %.0f %%: ",
      100 * load, bit_rate / 1000, rate, 100 * max_load);
  if (fits >= min_rate) return problem + formatted("set robot.rate to at most %.0f", fits);
  return problem + formatted("no robot.rate fits; set a bit rate of at least %.0f kbit/s, or use more buses",
                             std::ceil((bits.per_cycle * min_rate + bits.per_second) / max_load / 1000));
}

}  // namespace robot_control
