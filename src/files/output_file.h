#pragma once
/// Output files are written completely or not at all.
///
/// The method depends on the object at the path:
///   nothing          a temporary file beside it is written, synchronised and renamed
///   a regular file   as above; the new file has the mode and owner of the old one. If the owner cannot be kept, the
///                    old file is overwritten in place
///   a symbolic link  the rules apply to the target of the link, which need not exist; the link stays
///   anything else    a device, FIFO or socket is opened and written to, never replaced

#include <string>
#include <vector>

namespace robot_control {

/// Throws std::system_error, which names the file. The file then has its old content, unless it was overwritten in
/// place. A process that calls this ignores SIGXFSZ (process_limits.h).
void write_output_file(const std::string& path, const std::string& text);

struct OutputFile {
  std::string path, text;
};

/// Writes files that belong together. All of them are written beside the old ones before the first one is renamed. An
/// error before that changes none of them, unless one is overwritten in place.
void write_output_files(const std::vector<OutputFile>& files);

}  // namespace robot_control
