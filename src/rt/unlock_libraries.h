#pragma once
/// Takes single shared libraries out of the locked memory of a process.

#include <cstddef>
#include <span>
#include <string_view>

namespace robot_control {

/// Unlocks code and constants of every loaded library whose file name begins with one of `names`, and gives up their
/// pages. A thread that uses them later reads them from the file again, at the cost of a page fault. Writable segments
/// hold relocated addresses and stay as they are. Returns the number of bytes.
std::size_t unlock_libraries(std::span<const std::string_view> names) noexcept;

}  // namespace robot_control
