#pragma once
/// Counts how often this thread allocates or releases heap memory while the guard lives:
///
///   AllocationGuard guard;
///   law.step(input, dt);
///   EXPECT_EQ(guard.count(), 0u);
///
/// malloc, calloc, realloc, aligned_alloc, posix_memalign, memalign and free of a non-null pointer count one
/// each, and with them operator new and delete. The sanitizers bring allocators of their own; there kCounts is
/// false, nothing is counted, and such a test shows only that its steps are sound.

#include <cstdint>

namespace robot_control {

class AllocationGuard {
 public:
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr bool kCounts = false;
#else
  static constexpr bool kCounts = true;
#endif

  AllocationGuard() noexcept;
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// Calls of this thread since construction.
  std::uint64_t count() const noexcept;

 private:
  std::uint64_t before_;
};

}  // namespace robot_control
