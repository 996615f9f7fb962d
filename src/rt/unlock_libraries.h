#pragma once
/// Takes single shared libraries out of the locked memory of a process.

#include <cstddef>
#include <span>
#include <string_view>

namespace robot_control {

/// Unlocks code and constants of every library that is loaded now and whose file name begins with one of `names`, and
/// gives up their pages. A thread that uses them later reads them from the file again, at the cost of a page fault.
/// Writable segments hold relocated addresses and stay as they are, as do libraries whose code is relocated. Returns
/// the number of bytes that were given up.
std::size_t unlock_libraries(std::span<const std::string_view> names) noexcept;

}  // namespace robot_control
