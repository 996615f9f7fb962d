#pragma once
/// The log as a table, run.csv in a folder (csv_writer.h, log_folder.h).
///
/// A disk that does not take its rows ends the file, not the log, as it does with run.bag: rows are counted, and every
/// `kRetryNs` another file is begun, the one before being kept under the next number. So it is with one that has all
/// of the room which it may have.

#include <cstdint>
#include <memory>
#include <vector>

#include "telemetry/csv_writer.h"
#include "telemetry/log_folder.h"
#include "telemetry/row_log.h"

namespace robot_control {

class CsvLog final : public RowLog {
 public:
  using RowLog::write;

  static constexpr std::int64_t kRetryNs = 10'000'000'000;

  /// Begins run.csv in `folder`, which lives longer. Throws LogError.
  CsvLog(LogFolder& folder, std::vector<Column> columns);

  /// Throws LogError once, when the disk takes no more.
  void write(const JoinedRow& row) override;

  /// At 10 Hz, `now_ns` on any clock that runs: hands what is buffered to the system; after an error another file is
  /// tried. Throws LogError.
  void poll(std::int64_t now_ns);

  void close() override;

  std::uint64_t unwritten() const noexcept { return unwritten_; }  ///< rows that the disk should have taken and has not
  bool broken() const noexcept { return writer_ == nullptr; }      ///< no file is open since the last error

 private:
  void begin();
  template <class Act>
  void with_writer(Act act);

  LogFolder& folder_;
  std::vector<Column> columns_;
  std::unique_ptr<CsvWriter> writer_;
  std::uint64_t given_ = 0;  ///< rows, to this writer
  std::uint64_t unwritten_ = 0;
  std::int64_t retry_ns_ = 0;
};

}  // namespace robot_control
