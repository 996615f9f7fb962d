#pragma once
/// The kernel is the reference for every step's cost: a chain of 64 dependent multiply-adds. It takes 512 cycles of
/// latency for any caches, branches and compilers; on the quiet development machine that is 92 ns.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "rt/clock.h"

namespace robot_control::bench {

inline constexpr int kKernelChain = 64;
inline constexpr double kKernelNs = 92;  ///< measured, quiet

/// ns per chain, over a block of `steps`.
inline double kernel_block(std::size_t steps) {
  volatile double seed = 1.0000001;
  double x = seed;
  const std::int64_t start = monotonic_ns();
  for (std::size_t k = 0; k < steps; ++k) {
    for (int i = 0; i < kKernelChain; ++i) x = x * 0.999999 + 1.0e-7;
  }
  const std::int64_t end = monotonic_ns();
  seed = x;
  return static_cast<double>(end - start) / static_cast<double>(steps);
}

/// The same, at least kKernelNs: a bound in nanoseconds does not shrink on a faster machine.
inline double reference_block(std::size_t steps) {
  return std::max(kKernelNs, kernel_block(steps));
}

}  // namespace robot_control::bench
