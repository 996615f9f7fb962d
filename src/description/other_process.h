#pragma once
/// Work that is done in a process of its own: another program, or a library that must not take ours down.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace robot_control {

struct ProcessResult {
  enum class End {
    kExited,
    kNotStarted,  ///< no such program, or no processes left
    kEnded,       ///< by us: it was silent for too long or wrote more than kMostOutput
    kKilled,      ///< by a signal
  };
  End end = End::kNotStarted;
  int code = 0;  ///< exit code, or number of the signal
  std::string output;
  std::string errors;
};

inline constexpr std::size_t kMostOutput = std::size_t{1} << 30U;  ///< bytes, of output and errors each

/// Runs `arguments[0]` (a path, or a name looked for on PATH), without a shell, with our environment and the
/// `environment` entries ("NAME=VALUE") laid over it, nothing on its standard input. One that writes nothing for
/// `silence` seconds is killed.
ProcessResult run_program(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                          int silence);

/// Runs `work` in a copy of this process (fork) and hands back what it returns as `output`. Whatever it does, a crash
/// included, stays there. It gets kApartMemory, kApartSeconds of processor time, no core file, and must not wait for
/// other threads, for they are not copied. An exception ends it with code 1.
ProcessResult run_apart(const std::function<std::string()>& work);

inline constexpr std::size_t kApartMemory = std::size_t{1} << 30U;  ///< bytes beyond ours
inline constexpr int kApartSeconds = 20;

}  // namespace robot_control
