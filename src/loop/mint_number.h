#pragma once
/// Random numbers that tell runs and processes apart.

#include <cstdint>
#include <random>

namespace robot_control {

/// A random number, never 0: of a run, of a process.
inline std::uint64_t mint_number() {
  std::random_device device;
  std::uint64_t number = 0;
  while (number == 0) number = (std::uint64_t{device()} << 32) | device();
  return number;
}

}  // namespace robot_control
