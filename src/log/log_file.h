#pragma once
/// A file of a log grows by whole parts and ends with its last whole part, whatever the disk does.
///
/// Without room, on a full disk or after another error, the file ends, and LogError says why, once: `open` is false
/// then, and the owner writes no more. Bytes written to a removed file are lost without an error; `check_presence`
/// notices it.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "files/descriptor.h"

namespace robot_control {

class LogFile {
 public:
  /// True: the file may grow to so many bytes. An empty function sets no limit.
  using Room = std::function<bool(std::int64_t)>;

  /// Makes the folders above `path` and replaces the file. Throws LogError.
  LogFile(std::string path, Room room);

  /// Throws LogError where the file is not at its path any more.
  void check_presence();

  /// Appends one part. Throws LogError.
  void append(std::string_view part);

  /// Replaces the file's first bytes. Throws LogError.
  void replace_begin(std::string_view bytes);

  /// Synchronises and closes the file. Throws LogError. Without this call it is closed at last, and errors are ignored.
  void close();

  bool open() const noexcept { return file_.open(); }
  std::int64_t bytes() const noexcept { return bytes_; }  ///< size up to the end of the last whole part
  const std::string& path() const noexcept { return path_; }

 private:
  [[noreturn]] void fail(const std::string& what, int error);

  std::string path_;
  Room room_;
  Descriptor file_;
  std::int64_t bytes_ = 0;
};

}  // namespace robot_control
