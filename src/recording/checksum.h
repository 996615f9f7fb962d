#pragma once
/// The checksum of messages of a log and of records of a black box. It shows that something was changed; it is no
/// protection against an author who computes it again.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace robot_control {

/// Sum of words; each mixes into all bits.
class Checksum {
 public:
  void mix(std::uint64_t word) {
    sum_ = (sum_ ^ word) * 0x9E3779B97F4A7C15U;
    sum_ ^= sum_ >> 29U;
  }
  void mix(std::string_view data) {
    std::uint64_t word = 0;
    for (; data.size() >= sizeof word; data.remove_prefix(sizeof word)) {
      std::memcpy(&word, data.data(), sizeof word);
      mix(word);
    }
    if (data.empty()) return;
    word = 0;
    std::memcpy(&word, data.data(), data.size());
    mix(word);
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xCBF29CE484222325U;
};

/// Of a message that stands under this time in the bag; `bytes`: those before its checksum. Half a sum: every row
/// carries one, and it cannot be compressed.
inline std::uint32_t message_checksum(std::string_view bytes, std::int64_t time_ns) {
  Checksum sum;
  sum.mix(static_cast<std::uint64_t>(time_ns));
  sum.mix(bytes);
  return static_cast<std::uint32_t>(sum.sum() >> 32U);
}

}  // namespace robot_control
