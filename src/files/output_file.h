#pragma once
/// Files that are written whole or not at all.
///
/// What stands at the path decides:
///   nothing          a temporary file beside it is written, synchronised and renamed
///   a regular file   the same; the new one has its mode and owner. Where the owner cannot be kept, it is
///                    overwritten in place
///   a symbolic link  holds for the file that it leads to, there or not; the link stays
///   anything else    a device, FIFO or socket is opened and written to, never replaced

#include <string>

namespace robot_control {

/// Throws std::system_error, which names the file; nothing but the old content is left then, except where the file was
/// overwritten in place. A process that calls this ignores SIGXFSZ (process_limits.h).
void write_output_file(const std::string& path, const std::string& text);

}  // namespace robot_control
