#pragma once
/// The count of a drive whose counter overflows at 32 bits.

#include <cstdint>

namespace robot_control {

/// Returns the count next to `last` whose lower 32 bits are `raw`.
inline std::int64_t continued_count(std::int64_t last, std::int32_t raw) noexcept {
  const auto low = static_cast<std::uint32_t>(last);
  return last + static_cast<std::int32_t>(static_cast<std::uint32_t>(raw) - low);
}

}  // namespace robot_control
