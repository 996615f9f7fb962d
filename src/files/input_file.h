#pragma once
/// Files that a user names are read only if they are regular files up to a stated size.
///
/// A folder, device, FIFO or socket is reported as a problem, so that no program waits or reads without end. The path
/// is checked before it is opened, because the opening of some devices has an effect. The descriptor is checked again.

#include <cstddef>
#include <string>

namespace robot_control {

/// These sizes are in bytes. A parameter file or calibration has some kB; a description or scene with its shapes has
/// some MB. A command script has 30 bytes per row, so one row per cycle at 1 kHz makes 108 MB per hour.
inline constexpr std::size_t kMaxParameterFile = std::size_t{1} << 20U;
inline constexpr std::size_t kMaxDescription = std::size_t{64} << 20U;
inline constexpr std::size_t kMaxScript = std::size_t{256} << 20U;

struct InputFile {
  std::string text;
  std::string problem;  ///< "is a FIFO"; empty: `text` is the whole file
};

/// Reads the file; more than `max_bytes` bytes are a problem.
InputFile read_input_file(const std::string& path, std::size_t max_bytes);

/// Returns the problem of a file that a library opens by itself, without reading it; "" if there is none.
std::string input_file_problem(const std::string& path, std::size_t max_bytes);

}  // namespace robot_control
