#pragma once
/// The kernel counts what a thread does. Any other thread reads the counts from /proc without privileges.

#include <cstdint>
#include <optional>
#include <string>

namespace robot_control {

/// Counts since the thread began.
struct ThreadCounters {
  std::uint64_t page_faults = 0;  ///< minor and major
  std::uint64_t voluntary_switches = 0;
  std::uint64_t forced_switches = 0;
  std::optional<std::uint64_t> run_queue_ns = {};  ///< ready, but not running; empty: the kernel does not count it
};

/// `thread` is its id (gettid(2)), `root` another folder than /proc. Returns nothing for a thread that has ended.
std::optional<ThreadCounters> read_thread_counters(int thread, const std::string& root = "/proc");

/// Time of all processors since boot, in clock ticks.
struct MachineTime {
  std::uint64_t total = 0;
  std::uint64_t stolen = 0;  ///< a task was ready, but the hypervisor ran another machine
};

/// Returns zeros if the file cannot be read.
MachineTime read_machine_time(const std::string& root = "/proc");

}  // namespace robot_control
