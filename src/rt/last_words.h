#pragma once
/// A process that crashes reports it in one line on stderr: node, signal, reason, remedy.
///
///   SIGBUS    memory that was mapped is gone: shared memory truncated, or its file system full
///   SIGSEGV   an invalid address                  SIGILL, SIGFPE      an invalid instruction, a division by zero
///   SIGABRT   it called abort: the message before says why
///
/// Then it ends by the same signal: exit status and core dump are those of a process without this report. Between
/// fault and end there is no lock, no allocation and no wait, and only async-signal-safe calls (signal-safety(7)); if
/// stderr does not accept the line at once, it is dropped. The line is one write, so lines of several processes do not
/// mix.

#include <array>
#include <cstddef>
#include <string>

namespace robot_control {

inline constexpr std::size_t kMaxName = 64;  ///< bytes; more is cut off
inline constexpr std::size_t kMaxConsequence = 100;

/// `name`: of the node; `consequence`: of its end, "the motors brake without it". Earlier handlers of these signals are
/// replaced, and the calling thread, the main one, gets an AlternateStack. Once per process, before it has threads.
void install_last_words(const std::string& name, const std::string& consequence);

/// Stack for the report of one thread whose own stack has overflowed, as long as this object lives. Where the thread
/// has such a stack already (AddressSanitizer gives it), that stays.
class AlternateStack {
 public:
  AlternateStack() noexcept;
  AlternateStack(const AlternateStack&) = delete;
  AlternateStack& operator=(const AlternateStack&) = delete;
  ~AlternateStack();

 private:
  static constexpr std::size_t kBytes = 32 * 1024;  ///< the registers of the widest x86 take 11 KiB of it

  bool mine_ = false;
  alignas(64) std::array<std::byte, kBytes> memory_;
};

}  // namespace robot_control
