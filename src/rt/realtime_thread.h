#pragma once
/// A RealtimeThread is the one thread of a process that runs in real time; `prepare_process` prepares the process for
/// it.
///
/// First, `prepare_process` is called before the process has threads (with ROS, before the first NodeHandle). It makes
/// the stacks of later threads small and locks the memory. Then the ordinary threads are started, at last the
/// RealtimeThread. That thread sets its core and SCHED_FIFO itself immediately before the body runs, so that no other
/// thread inherits them. While it exists, the idle states of the processors are limited, if that is requested
/// (LatencyRequest).
///
/// Each refused request is reported with its remedy: "<what> (<why>; remedy: <line of /etc/security/limits.d or
/// capability>)". Under kRequired a refusal is an error at start-up. The core needs no privilege and is set under every
/// policy.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "parameters/block.h"

namespace robot_control {

/// Takes every library that is loaded now and whose file name begins with one of `names` out of the locked memory. Its
/// code and constants are unlocked, and their pages given up. A thread that uses them later reads them from the file
/// again, at the cost of a page fault. Writable segments hold relocated addresses and stay as they are, as do libraries
/// whose code is relocated. Returns the number of bytes that were given up.
std::size_t unlock_libraries(std::span<const std::string_view> names) noexcept;

/// For an ordinary thread that must not wait for other programs, but is no part of the loop. Gives the calling thread
/// the lowest priority of SCHED_FIFO: before all ordinary threads of the machine, after every RealtimeThread. Threads
/// that it starts are ordinary. Returns false and changes nothing if that is not granted (docs/realtime.md).
bool precede_ordinary_threads() noexcept;

inline constexpr const char* kLatencyDevice = "/dev/cpu_dma_latency";

/// A LatencyRequest limits how deep the processors of the machine may sleep while they are idle.
///
/// A processor needs up to some hundred µs to leave a deep idle state. A 32-bit number of µs that is written
/// to /dev/cpu_dma_latency excludes the idle states with a longer exit latency; 0 permits polling alone. The smallest
/// of all requests holds for all processors. A request ends when its descriptor is closed, also by the end of the
/// process. Source: the kernel's documentation, power/pm_qos_interface.
class LatencyRequest {
 public:
  LatencyRequest() = default;  ///< requests nothing

  /// Opens the device and writes the request. A refusal is no exception: `refusal` returns it.
  explicit LatencyRequest(std::int32_t latency_us, const char* device = kLatencyDevice);
  LatencyRequest(const LatencyRequest&) = delete;
  LatencyRequest& operator=(const LatencyRequest&) = delete;
  ~LatencyRequest();

  /// Returns what was refused, why, and the remedy; "" if the request is in force or nothing was requested.
  const std::string& refusal() const noexcept { return refusal_; }

 private:
  int descriptor_ = -1;
  std::string refusal_;
};

enum class RealtimePolicy {
  kRequired,   ///< the node starts only if everything is granted
  kPreferred,  ///< the node uses what is granted
  kOff,        ///< only the core is set; no priority, locked memory or limit of idle states is requested
};

inline std::vector<Word> words_of(RealtimePolicy) {
  using enum RealtimePolicy;
  return {{"required", kRequired}, {"preferred", kPreferred}, {"off", kOff}};
}

enum class Grant { kNotRequested, kGranted, kRefused };

struct RealtimeReport {
  Grant memory_lock = Grant::kNotRequested;
  Grant priority = Grant::kNotRequested;
  Grant core = Grant::kNotRequested;
  Grant cpu_latency = Grant::kNotRequested;
  std::vector<std::string> refusals;  ///< one per Grant::kRefused
};

/// The text lists all refusals, one per line.
class RealtimeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Locks all present and future memory of the process with CAP_IPC_LOCK or an unlimited RLIMIT_MEMLOCK. Under a finite
/// limit nothing is locked, because later mappings and threads would fail at that limit. Locked memory is resident
/// memory. So, when memory is locked, the allocator keeps two arenas that it never trims, and later threads get stacks
/// of 1 MiB. Code of large libraries that no loop calls is not locked (unlock_libraries). Repeated calls return the
/// result of the first call. With kOff nothing is requested. A refusal is not thrown here, but by RealtimeThread, which
/// has it in its report.
RealtimeReport prepare_process(RealtimePolicy policy);

struct RealtimeParameters {
  std::string name = "loop";  ///< name in /proc/<pid>/task/<tid>/comm, at most 15 bytes
  RealtimePolicy policy = RealtimePolicy::kPreferred;
  int priority = 0;  ///< SCHED_FIFO 1 … 99; 0: ordinary scheduling
  int core = -1;     ///< -1: any
  /// The longest exit latency of an idle state, µs; none: not requested.
  std::optional<std::int32_t> cpu_latency_us = std::nullopt;
};

class RealtimeThread {
 public:
  /// Calls `prepare_process`, starts the thread and waits until it has its core and priority. Then the body starts.
  /// Under kRequired any refusal throws RealtimeError, and the body is not run. The body must not throw. The stack of
  /// kStackBytes is mapped and prefaulted before the thread begins.
  RealtimeThread(const RealtimeParameters& parameters, std::function<void()> body);
  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;
  ~RealtimeThread();  ///< joins the thread

  /// Waits for the end of the body.
  void join();

  const RealtimeReport& report() const noexcept { return report_; }

  /// The id of the thread in /proc (gettid(2)).
  int id() const noexcept;

  /// The number of system calls with which the thread has waited (rt/wait_count.h).
  std::uint64_t waits() const noexcept;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr std::size_t kStackBytes = 4096 * 1024;  ///< a sanitizer uses 0.9 MB of the stack
#else
  static constexpr std::size_t kStackBytes = 512 * 1024;
#endif

 private:
  struct Thread;
  RealtimeReport report_;
  std::unique_ptr<LatencyRequest> latency_;
  std::unique_ptr<Thread> thread_;
};

}  // namespace robot_control
