#pragma once
/// Counts the system calls with which a thread waits. Other voluntary switches of a real-time thread are violations.

#include <atomic>
#include <cstdint>

namespace robot_control {

/// From now on the waits of the calling thread are counted in `counter`, which must outlive it. Null: nowhere.
void count_waits_in(std::atomic<std::uint64_t>* counter) noexcept;

/// Counts one wait of the calling thread, before its system call.
void count_wait() noexcept;

}  // namespace robot_control
