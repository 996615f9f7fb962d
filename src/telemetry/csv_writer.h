#pragma once
/// The log as a table: one header line, one line per row, the columns of `log_columns`.
///
/// Reals are the shortest decimals that read back as the same bits ("nan", "inf" where a node computed such),
/// integers are decimal, a cell whose node has no frame is empty; lines end in LF. Equal rows give equal bytes.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "telemetry/columns.h"
#include "telemetry/log_error.h"
#include "telemetry/log_file.h"
#include "telemetry/row_log.h"

namespace robot_control {

class CsvWriter final : public RowLog {
 public:
  using RowLog::write;

  /// Makes the folders above `path` where they are missing, replaces the file and writes the header line. Without
  /// `room` for its buffer the log ends as on a full disk. Throws LogError.
  CsvWriter(std::string path, std::vector<Column> columns, LogFile::Room room = {});

  /// Closes without a word; call `close` to learn of errors.
  ~CsvWriter() override;
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  /// Throws LogError when the disk does not take the buffer, once; the log then ends with its last whole row, and rows
  /// are ignored.
  void write(const JoinedRow& row) override;

  /// Hands what is buffered to the system, for processes that read the file meanwhile. Throws LogError.
  void flush();

  /// flush, fsync, close. Throws LogError.
  void close() override;

  /// Whole rows that the system has taken.
  std::uint64_t rows() const noexcept { return lines_ == 0 ? 0 : lines_ - 1; }

 private:
  LogFile file_;
  std::vector<Column> columns_;
  std::string buffer_;
  std::uint64_t lines_ = 0;  ///< whole, the header's included
};

}  // namespace robot_control
