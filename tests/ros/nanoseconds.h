#pragma once
/// Times of stamps.

#include <cstdint>

namespace robot_control {

inline constexpr std::int64_t kSecond = 1'000'000'000;  ///< ns
inline constexpr std::int64_t kHour = 3600 * kSecond;   ///< ns

}  // namespace robot_control
