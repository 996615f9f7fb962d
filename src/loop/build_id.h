#pragma once
/// Which build this is: a hash of the sources of the laws, the compiler and its options. Equal builds compute the same
/// bits from the same state, and lay the state out in the same way.

#include <cstdint>

namespace robot_control {

std::uint64_t build_id() noexcept;

}  // namespace robot_control
