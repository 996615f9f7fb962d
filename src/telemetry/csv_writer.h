#pragma once
/// The log as a table: one header line, one line per row, the columns of `log_columns`.
///
/// Reals are the shortest decimals that read back as the same bits ("nan", "inf" where a node computed such),
/// integers are decimal, a cell whose node has no frame is empty; lines end in LF. Equal rows give equal bytes.

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
  /// Makes the folders above `path` where they are missing, replaces the file and writes the header line.
  /// Throws LogError.
  CsvWriter(std::string path, std::vector<Column> columns);

  /// Closes without a word; call `close` to learn of errors.
  ~CsvWriter();
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  /// Throws LogError when the disk does not take the buffer, once; afterwards rows are ignored.
  void write(const JoinedRow& row);

  /// Hands what is buffered to the system, for those who read along. Throws LogError.
  void flush();

  /// flush, fsync, close. Throws LogError.
  void close();

 private:
  void open();
  [[noreturn]] void fail(const std::string& what, int error);

  std::string path_;
  std::vector<Column> columns_;
  std::string buffer_;
  int file_ = -1;
};

}  // namespace robot_control
