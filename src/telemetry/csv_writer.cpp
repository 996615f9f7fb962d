#include "telemetry/csv_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

namespace robot_control {
namespace {

constexpr std::size_t kBufferBytes = 1 << 18;  // some 300 rows: few system calls, little to lose

// 24 characters hold the longest shortest double; integers need 20.
template <class Number>
void append_number(std::string& to, Number value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  to.append(digits.data(), end);
}

void append_real(std::string& to, double value) {
  // The sign of a NaN is an accident of the instruction that made it.
  if (value != value) {
    to.append("nan");
  } else {
    append_number(to, value);
  }
}

}  // namespace

CsvWriter::CsvWriter(std::string path, std::vector<Column> columns, LogFile::Room room)
    : file_(std::move(path), std::move(room), " (beside run.bag half of it)"), columns_(std::move(columns)) {
  buffer_.reserve(kBufferBytes + 4096);
  for (const Column& column : columns_) buffer_.append(column.name).push_back(',');
  buffer_.back() = '\n';
  flush();
}

CsvWriter::~CsvWriter() {
  try {
    close();
  } catch (const LogError&) {
    // A caller that needs to know the result has called close().
  }
}

void CsvWriter::write(const JoinedRow& row) {
  if (!file_.open()) return;
  const PresentSources present = present_sources(row);
  for (const Column& column : columns_) {
    if (column.filled(present)) {
      if (column.real != nullptr) {
        append_real(buffer_, column.real(row, column.joint));
      } else {
        append_number(buffer_, column.integer(row, column.joint));
      }
    }
    buffer_.push_back(',');
  }
  buffer_.back() = '\n';
  if (buffer_.size() >= kBufferBytes) flush();
}

void CsvWriter::flush() {
  if (!file_.open()) return;
  file_.check_presence();
  file_.append(buffer_, [this](std::string_view taken) {
    lines_ += static_cast<std::uint64_t>(std::count(taken.begin(), taken.end(), '\n'));
    return taken.rfind('\n') + 1;  // npos + 1 is 0
  });
  buffer_.clear();
}

void CsvWriter::close() {
  if (!file_.open()) return;
  flush();
  file_.close();
}

}  // namespace robot_control
