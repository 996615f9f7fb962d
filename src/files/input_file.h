#pragma once
/// Files that a user names: regular files up to a stated size, and nothing else.
///
/// A folder, device, FIFO or socket is a problem in words, never a wait and never memory without end. The path is
/// examined before it is opened, because the opening of some devices has an effect, and once more on the descriptor.

#include <cstddef>
#include <string>

namespace robot_control {

/// Bytes. A parameter file or calibration has some kB; a description or scene, with its shapes, some MB; a command
/// script has 30 bytes per row, a row per cycle for an hour at 1 kHz makes 108 MB.
inline constexpr std::size_t kMaxParameterFile = std::size_t{1} << 20U;
inline constexpr std::size_t kMaxDescription = std::size_t{64} << 20U;
inline constexpr std::size_t kMaxScript = std::size_t{256} << 20U;

struct InputFile {
  std::string text;
  std::string problem;  ///< "is a FIFO"; empty: `text` is the whole file
};

/// At most `most` bytes; more is a problem.
InputFile read_input_file(const std::string& path, std::size_t max_bytes);

/// The same judgement without reading, for files that a library opens by itself; empty: none.
std::string input_file_problem(const std::string& path, std::size_t max_bytes);

}  // namespace robot_control
