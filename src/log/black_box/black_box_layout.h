#pragma once
/// Writer and reader of a black box share this layout of its file (black_box_file.h).

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "log/log_error.h"
#include "signals/checksum.h"

namespace robot_control::black_box_layout {

inline constexpr char kMagic[8] = {'R', 'C', 'B', 'L', 'A', 'C', 'K', '2'};

struct Head {
  char magic[8];
  std::uint64_t head_bytes, segments, description_bytes;
  std::uint64_t checksum;  ///< covers these members and the description
  std::uint64_t ended;
};

struct RecordHead {
  std::uint64_t checksum = 0;  ///< covers the members below and the data
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
  std::uint32_t kind = 0, length = 0;
};

inline constexpr std::size_t kAlignment = 8;

inline std::size_t padded(std::size_t bytes) {
  return (bytes + kAlignment - 1) & ~(kAlignment - 1);
}

inline std::uint64_t checksum_of(const RecordHead& head, std::string_view data) {
  Checksum sum;
  sum.mix(head.sequence);
  sum.mix(static_cast<std::uint64_t>(head.time_ns));
  sum.mix((std::uint64_t{head.kind} << 32U) | head.length);
  sum.mix(data);
  return sum.sum();
}

inline std::uint64_t checksum_of(const Head& head, std::string_view description) {
  Checksum sum;
  sum.mix(head.head_bytes);
  sum.mix(head.segments);
  sum.mix(head.description_bytes);
  sum.mix(description);
  return sum.sum();
}

[[noreturn]] inline void fail(const std::string& path, const std::string& problem) {
  throw LogError(path + ": " + problem);
}

}  // namespace robot_control::black_box_layout
