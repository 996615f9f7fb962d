#pragma once
/// Another program, run to its end without a shell.

#include <string>
#include <vector>

namespace robot_control {

struct ProgramResult {
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

inline constexpr std::size_t kMostOutput = 64U << 20U;  ///< bytes, of output and errors each

/// Runs `arguments[0]` (a path, or a name looked for on PATH) with our environment and the `environment` entries
/// ("NAME=VALUE") laid over it, nothing on its standard input. A program that writes nothing for `silence` seconds
/// is killed.
ProgramResult run_program(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                          int silence);

}  // namespace robot_control
