#pragma once
/// Every message of a log carries this checksum.

#include <cstdint>
#include <string_view>

#include "signals/checksum.h"

namespace robot_control {

/// `time_ns` is the time of the message in the bag, and `bytes` are those before its checksum. It is half a sum,
/// because every row carries one and it cannot be compressed.
inline std::uint32_t message_checksum(std::string_view bytes, std::int64_t time_ns) {
  Checksum sum;
  sum.mix(static_cast<std::uint64_t>(time_ns));
  sum.mix(bytes);
  return static_cast<std::uint32_t>(sum.sum() >> 32U);
}

}  // namespace robot_control
