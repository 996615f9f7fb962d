#pragma once
/// Runs work in a separate process: another program, or a library that may crash.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace robot_control {

struct ProcessResult {
  enum class End {
    kExited,
    kNotStarted,  ///< There is no such program, or no more process can be created.
    kEnded,       ///< The parent killed it: it was silent for too long or wrote more than kMaxOutput.
    kKilled,      ///< killed by a signal
  };
  End end = End::kNotStarted;
  int code = 0;  ///< exit code or number of the signal
  std::string output;
  std::string errors;
};

inline constexpr std::size_t kMaxOutput = std::size_t{1} << 30U;  ///< bytes of output and of errors

/// Runs `arguments[0]`, a path or a name found on PATH, without a shell and without standard input. The entries of
/// `environment` ("NAME=VALUE") replace those of this process. A program that writes nothing for `silence` seconds is
/// killed.
ProcessResult run_program(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                          int silence);

/// Runs `work` in a copy of this process (fork) and returns its result as `output`. Its effects stay in the copy, a
/// crash included. The copy has kChildMemory, kChildSeconds of processor time and no core file. It must not wait for
/// other threads, which are not copied. An exception ends it with code 1.
ProcessResult run_apart(const std::function<std::string()>& work);

inline constexpr std::size_t kChildMemory = std::size_t{1} << 30U;  ///< bytes beyond those of this process
inline constexpr int kChildSeconds = 20;

}  // namespace robot_control
