#pragma once
/// The number of wheels for which frames and laws have room.

#include <cstddef>

namespace robot_control {

inline constexpr std::size_t kMaxWheels = 8;

}  // namespace robot_control
