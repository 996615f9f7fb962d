#include "telemetry/csv_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
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

CsvWriter::CsvWriter(std::string path, std::vector<Column> columns, Room room)
    : path_(std::move(path)), columns_(std::move(columns)), room_(std::move(room)) {
  open();
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

void CsvWriter::open() {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) fail("cannot make its folder", error.value());
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ < 0) fail("cannot be opened", errno);
}

void CsvWriter::write(const JoinedRow& row) {
  if (file_ < 0) return;
  for (const Column& column : columns_) {
    if (column.present(row)) {
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
  std::size_t done = 0;
  if (file_ >= 0 && room_ && !room_(bytes_ + static_cast<std::int64_t>(buffer_.size()))) {
    end();
    throw LogError("log " + path_ +
                   " has ended: telemetry.quota is reached and no older log can be removed; remedy: start telemetry "
                   "again, then this log may be removed, or raise telemetry.quota or make room");
  }
  while (file_ >= 0 && done < buffer_.size()) {
    const ssize_t taken = ::write(file_, buffer_.data() + done, buffer_.size() - done);
    if (taken < 0 && errno == EINTR) continue;
    if (taken < 0) {
      const int error = errno;
      count(done);
      // Half a row would be read as one with less columns. A pipe cannot be cut, nor need it be.
      [[maybe_unused]] const int cut = ::ftruncate(file_, bytes_);
      fail("cannot be written", error);
    }
    done += static_cast<std::size_t>(taken);
  }
  count(done);
  buffer_.clear();
}

void CsvWriter::count(std::size_t taken) {
  const std::string_view text(buffer_.data(), taken);
  lines_ += static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
  const std::size_t end = text.rfind('\n');
  if (end != std::string_view::npos) bytes_ += static_cast<std::int64_t>(end) + 1;
}

void CsvWriter::close() {
  if (file_ < 0) return;
  flush();
  // Pipes and devices have nothing to synchronise.
  if (::fsync(file_) != 0 && errno != EINVAL && errno != EROFS) fail("cannot be completed", errno);
  const int file = std::exchange(file_, -1);
  if (::close(file) != 0) fail("cannot be closed", errno);
}

void CsvWriter::end() noexcept {
  if (file_ >= 0) ::close(std::exchange(file_, -1));
  buffer_.clear();
}

void CsvWriter::fail(const std::string& what, int error) {
  end();
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw LogError("log " + path_ + " " + what + ": " + std::strerror(error) +
                 (full ? "; make room or name another folder" : "; name a folder that can be written") +
                 " (telemetry.directory)");
}

}  // namespace robot_control
