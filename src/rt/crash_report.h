#pragma once
/// A process that crashes reports it in one line on stderr: node, signal, reason, remedy.
///
///   SIGBUS    mapped memory no longer exists: shared memory was truncated, or its file system is full
///   SIGSEGV   an invalid address                  SIGILL, SIGFPE      an invalid instruction, a division by zero
///   SIGABRT   the process called abort: the message before gives the reason
///
/// The process then ends by the same signal, so that exit status and core dump are as without this report. Between
/// fault and end there is no lock, no allocation and no wait, and all calls are async-signal-safe (signal-safety(7)).
/// If stderr does not accept the line at once, it is dropped. The line is one write, so lines of several processes do
/// not mix.

#include <array>
#include <cstddef>
#include <string>

namespace robot_control {

inline constexpr std::size_t kMaxName = 64;  ///< bytes; a longer name is cut
inline constexpr std::size_t kMaxConsequence = 100;

/// Installs the handlers. `name` is the node's name, `consequence` the consequence of its end: "the motors brake
/// without it". Earlier handlers of these signals are replaced, and the calling main thread gets an AlternateStack. It
/// is called once per process, before other threads exist.
void install_crash_report(const std::string& name, const std::string& consequence);

/// While this object lives, the calling thread has a second stack, on which it can report an overflow of its own stack.
/// If the thread has such a stack already (from AddressSanitizer), that one stays.
class AlternateStack {
 public:
  AlternateStack() noexcept;
  AlternateStack(const AlternateStack&) = delete;
  AlternateStack& operator=(const AlternateStack&) = delete;
  ~AlternateStack();

 private:
  static constexpr std::size_t kBytes = 32 * 1024;  ///< the registers of the largest x86 processors need 11 KiB of it

  bool mine_ = false;
  alignas(64) std::array<std::byte, kBytes> memory_;
};

}  // namespace robot_control
