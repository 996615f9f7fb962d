#pragma once
/// The log as a table: one header line, one line per row, the columns of `log_columns`.
///
/// Reals are the shortest decimals that read back as the same bits ("nan", "inf" where a node computed such),
/// integers are decimal, a cell whose node has no frame is empty; lines end in LF. Equal rows give equal bytes.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "telemetry/columns.h"

namespace robot_control {

/// What could not be written, why, what to do.
class LogError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class CsvWriter {
 public:
  /// Whether the file may grow to so many bytes.
  using Room = std::function<bool(std::int64_t)>;

  /// Makes the folders above `path` where they are missing, replaces the file and writes the header line. Without
  /// `room` for its buffer the log ends as on a full disk. Throws LogError.
  CsvWriter(std::string path, std::vector<Column> columns, Room room = {});

  /// Closes without a word; call `close` to learn of errors.
  ~CsvWriter();
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  /// Throws LogError when the disk does not take the buffer, once; the log then ends with its last whole row, and rows
  /// are ignored.
  void write(const JoinedRow& row);

  /// Hands what is buffered to the system, for processes that read the file meanwhile. Throws LogError.
  void flush();

  /// flush, fsync, close. Throws LogError.
  void close();

  /// Whole rows that the system has taken.
  std::uint64_t rows() const noexcept { return lines_ == 0 ? 0 : lines_ - 1; }

 private:
  void open();
  void count(std::size_t taken);
  void end() noexcept;
  [[noreturn]] void fail(const std::string& what, int error);

  std::string path_;
  std::vector<Column> columns_;
  Room room_;
  std::string buffer_;
  int file_ = -1;
  std::int64_t bytes_ = 0;   ///< up to the end of the last whole line
  std::uint64_t lines_ = 0;  ///< whole, the header's included
};

}  // namespace robot_control
