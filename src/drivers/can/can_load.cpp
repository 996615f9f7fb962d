#include "drivers/can/can_load.h"

#include <cmath>
#include <cstdio>

namespace robot_control {
namespace {

constexpr unsigned kMaxEqualBits = 5;          // after which a stuff bit follows
constexpr std::uint32_t kPolynomial = 0x4599;  // CRC-15 of CAN, without its highest bit

/// Counts the bits of a frame as they pass, with those that are stuffed, and computes the checksum.
class BitCounter {
 public:
  void add(std::uint32_t value, unsigned bits) noexcept {
    while (bits-- > 0) {
      const bool bit = (value >> bits & 1U) != 0;
      const bool divide = bit != ((crc_ & 0x4000U) != 0);
      crc_ = (crc_ << 1U & 0x7FFFU) ^ (divide ? kPolynomial : 0);
      stuff(bit);
    }
  }

  /// The number of all bits up to the end of the checksum, which is sent, too.
  unsigned finish() noexcept {
    const std::uint32_t crc = crc_;
    add(crc, 15);
    return count_;
  }

 private:
  void stuff(bool bit) noexcept {
    equal_ = bit == last_ ? equal_ + 1 : 1;
    last_ = bit;
    ++count_;
    if (equal_ < kMaxEqualBits) return;
    ++count_;
    last_ = !bit;
    equal_ = 1;
  }

  std::uint32_t crc_ = 0;
  unsigned count_ = 0, equal_ = 0;
  bool last_ = true;  // the idle bus is recessive
};

struct Bits {
  double per_cycle = 0, per_second = 0;
};

Bits bits_of(std::span<const PlannedFrames> plan) noexcept {
  Bits sum;
  for (const PlannedFrames& frames : plan) {
    const unsigned bits = max_frame_bits(frames.extended, frames.data_bytes);
    sum.per_cycle += bits * frames.per_cycle;
    sum.per_second += bits * frames.per_second;
  }
  return sum;
}

}  // namespace

unsigned frame_bits(const can_frame& frame) noexcept {
  const bool remote = is_remote_request(frame);
  BitCounter counter;
  counter.add(0, 1);  // start of frame
  if (is_extended(frame)) {
    counter.add(frame.can_id >> 18U & CAN_SFF_MASK, 11);
    counter.add(3, 2);  // SRR and IDE, recessive
    counter.add(frame.can_id & 0x3FFFFU, 18);
    counter.add(remote ? 1 : 0, 1);
    counter.add(0, 2);  // reserved
  } else {
    counter.add(frame.can_id & CAN_SFF_MASK, 11);
    counter.add(remote ? 1 : 0, 1);
    counter.add(0, 2);  // IDE and the reserved bit
  }
  const std::uint8_t length = std::min<std::uint8_t>(frame.len, CAN_MAX_DLEN);
  counter.add(length, 4);
  for (std::uint8_t i = 0; i < length && !remote; ++i) counter.add(frame.data[i], 8);
  return counter.finish() + 13;
}

double bus_load(std::span<const PlannedFrames> plan, double rate, double bit_rate) noexcept {
  const Bits bits = bits_of(plan);
  return (bits.per_cycle * rate + bits.per_second) / bit_rate;
}

std::optional<std::string> bus_load_problem(std::span<const PlannedFrames> plan, double rate, double bit_rate,
                                            double min_rate) {
  const double load = bus_load(plan, rate, bit_rate);
  if (load <= kMaxBusLoad) return std::nullopt;
  const Bits bits = bits_of(plan);
  const double fits = bits.per_cycle > 0 ? std::floor((kMaxBusLoad * bit_rate - bits.per_second) / bits.per_cycle) : 0;
  char text[256];
  int length = std::snprintf(
      text, sizeof text,
      "the planned frames load the bus with %.0f %% of %.0f kbit/s at a robot.rate of %g Hz, more than %.0f %%: ",
      100 * load, bit_rate / 1000, rate, 100 * kMaxBusLoad);
  const auto room = sizeof text - static_cast<std::size_t>(length);
  if (fits >= min_rate) {
    std::snprintf(text + length, room, "set robot.rate to at most %.0f", fits);
  } else {
    std::snprintf(text + length, room, "no robot.rate fits; set a bit rate of at least %.0f kbit/s, or use two buses",
                  std::ceil((bits.per_cycle * min_rate + bits.per_second) / kMaxBusLoad / 1000));
  }
  return text;
}

}  // namespace robot_control
