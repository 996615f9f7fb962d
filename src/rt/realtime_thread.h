#pragma once
/// The one thread of a process that runs in real time, and the set-up of the process around it.
///
/// Order: `prepare_process` before the process has threads (with ROS: before the first NodeHandle; it makes the
/// stacks of later threads small and locks the memory), then everything ordinary, last a RealtimeThread. Core and
/// SCHED_FIFO are applied by that thread to itself as its last step before the body runs, so no other thread inherits
/// them.
///
/// What was requested and not granted is reported in a few words each, with the remedy: "<what> (<why>; remedy: <line
/// of /etc/security/limits.d or capability>)". Under kRequired that is an error at start-up. The core needs no
/// privilege and is applied whatever the policy says.

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace robot_control {

enum class RealtimePolicy {
  kRequired,   ///< all of it, or the node does not start
  kPreferred,  ///< what is granted
  kOff,        ///< the core alone: neither priority nor locked memory is asked for
};

enum class Grant { kNotAsked, kGranted, kRefused };

struct RealtimeReport {
  Grant memory_lock = Grant::kNotAsked;
  Grant priority = Grant::kNotAsked;
  Grant core = Grant::kNotAsked;
  std::vector<std::string> refusals;  ///< one per Grant::kRefused
};

/// All refusals, one per line.
class RealtimeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Locks all memory of the process, present and future, where no limit stands in the way: with CAP_IPC_LOCK or
/// an unlimited RLIMIT_MEMLOCK. Under a finite limit nothing is locked, because then later mappings and thread
/// creations would fail at that limit. Locked memory is resident memory, so where it is granted the allocator
/// is kept to two arenas that it never trims, and the stacks of later threads to 1 MiB.
/// Repeated calls return the first call's outcome. kOff: asks nothing. Never throws a refusal: that is the
/// duty of the RealtimeThread, which repeats it in its report.
RealtimeReport prepare_process(RealtimePolicy policy);

struct RealtimeParameters {
  std::string name = "loop";  ///< as in /proc/<pid>/task/<tid>/comm, at most 15 bytes
  RealtimePolicy policy = RealtimePolicy::kPreferred;
  int priority = 0;  ///< SCHED_FIFO 1 … 99; 0: ordinary scheduling
  int core = -1;     ///< -1: any
};

class RealtimeThread {
 public:
  /// Calls `prepare_process`, makes the thread and waits until it has its core and priority; the body starts
  /// then. Throws RealtimeError, with the body not run, under kRequired when anything was refused.
  /// The body must not throw. Stack: kStackBytes, mapped and prefaulted before the thread begins.
  RealtimeThread(const RealtimeParameters& parameters, std::function<void()> body);
  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;
  ~RealtimeThread();  ///< joins

  /// Waits for the body's end.
  void join();

  const RealtimeReport& report() const noexcept { return report_; }

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr std::size_t kStackBytes = 4096 * 1024;  ///< a sanitizer keeps 0.9 MB of its own there
#else
  static constexpr std::size_t kStackBytes = 512 * 1024;
#endif

 private:
  struct Thread;
  RealtimeReport report_;
  std::unique_ptr<Thread> thread_;
};

}  // namespace robot_control
