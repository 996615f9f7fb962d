#pragma once
/// Random numbers that tell runs and processes apart.

#include <cstdint>

namespace robot_control {

/// A random number, never 0: of a run, of a process.
std::uint64_t mint_number();

}  // namespace robot_control
