#pragma once
/// This is the checksum of all data except frames on the bus: messages of a log, records, files, a robot, the gate's
/// output. It detects changes, but does not protect against an author who computes it again.

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

namespace robot_control {

/// A sum of words, in which each word changes all bits.
class Checksum {
 public:
  void mix(std::uint64_t word) noexcept {
    sum_ = (sum_ ^ word) * 0x9E3779B97F4A7C15U;
    sum_ ^= sum_ >> 29U;
  }

  /// Mixes in `data`. The last word is filled up with zeros, and the length is not mixed in.
  void mix(std::string_view data) noexcept {
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

  std::uint64_t sum() const noexcept { return sum_; }

 private:
  std::uint64_t sum_ = 0xCBF29CE484222325U;
};

/// Returns the 16 digits in which sums and builds are written.
inline std::string hex(std::uint64_t number) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(number));
  return text.data();
}

}  // namespace robot_control
