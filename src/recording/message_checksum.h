#pragma once
/// The checksum of a message of a log.

#include <cstdint>
#include <string_view>

#include "signals/checksum.h"

namespace robot_control {

/// Of a message that stands under this time in the bag; `bytes`: those before its checksum. Half a sum: every row
/// carries one, and it cannot be compressed.
inline std::uint32_t message_checksum(std::string_view bytes, std::int64_t time_ns) {
  Checksum sum;
  sum.mix(static_cast<std::uint64_t>(time_ns));
  sum.mix(bytes);
  return static_cast<std::uint32_t>(sum.sum() >> 32U);
}

}  // namespace robot_control
