#include "telemetry/csv_log.h"

#include <string>
#include <utility>

namespace robot_control {

CsvLog::CsvLog(LogFolder& folder, std::vector<Column> columns) : folder_(folder), columns_(std::move(columns)) {
  begin();
}

void CsvLog::begin() {
  const std::string path = folder_.begin(LogKind::kCsv);
  writer_ = std::make_unique<CsvWriter>(path, columns_,
                                        [this](std::int64_t bytes) { return folder_.make_room(LogKind::kCsv, bytes); });
  given_ = 0;
}

template <class Act>
void CsvLog::with_writer(Act act) {
  try {
    act();
  } catch (const LogError&) {
    unwritten_ += given_ - writer_->rows();
    writer_ = nullptr;
    throw;
  }
}

void CsvLog::write(const JoinedRow& row) {
  if (writer_ == nullptr) {
    ++unwritten_;
    return;
  }
  ++given_;
  with_writer([&] { writer_->write(row); });
}

void CsvLog::poll(std::int64_t now_ns) {
  if (writer_ != nullptr) return with_writer([this] { writer_->flush(); });
  if (retry_ns_ == 0) retry_ns_ = now_ns + kRetryNs;
  if (now_ns < retry_ns_) return;
  retry_ns_ = now_ns + kRetryNs;
  begin();
  retry_ns_ = 0;
}

void CsvLog::close() {
  if (writer_ != nullptr) with_writer([this] { writer_->close(); });
}

}  // namespace robot_control
