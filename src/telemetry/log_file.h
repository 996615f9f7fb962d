#pragma once
/// A file of a log that grows by whole parts (rows, chunks) and ends with its last whole one, whatever the disk does.
///
/// Without room, on a full disk or another error, the file ends and LogError says why, once: `open` is false then, and
/// the owner writes no more. What is written to a file that was removed is lost without an error: ask `check_presence`.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace robot_control {

class LogFile {
 public:
  /// Whether the file may grow to so many bytes; empty: it may.
  using Room = std::function<bool(std::int64_t)>;

  /// How many of the bytes that the system took are whole parts. It took all of them, or the others failed.
  using Whole = std::function<std::size_t(std::string_view taken)>;

  /// Makes the folders above `path` and replaces the file. `share`: of the quota, as a part of the sentence that says
  /// that it is reached. Throws LogError.
  LogFile(std::string path, Room room, std::string share = {});

  /// Closes without a word; call `close` to learn of errors.
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  /// Throws LogError where the file is not at its path any more.
  void check_presence();

  /// Without `whole`, `bytes` are one part. Throws LogError.
  void append(std::string_view bytes, const Whole& whole = {});

  /// In place of the file's first bytes. Throws LogError.
  void replace_begin(std::string_view bytes);

  /// fsync, close. Throws LogError.
  void close();

  bool open() const noexcept { return file_ >= 0; }
  std::int64_t bytes() const noexcept { return bytes_; }  ///< up to the end of the last whole part
  const std::string& path() const noexcept { return path_; }

 private:
  void end() noexcept;
  [[noreturn]] void fail(const std::string& what, int error);

  std::string path_;
  Room room_;
  std::string share_;
  int file_ = -1;
  std::int64_t bytes_ = 0;
};

}  // namespace robot_control
