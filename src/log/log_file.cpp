#include "log/log_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/given_path.h"
#include "log/log_error.h"

namespace robot_control {
namespace {

/// The result is 0 where the open file is at its path, else the reason as errno.
int absence_of(int file, const std::string& path) noexcept {
  struct stat own {};
  struct stat present {};
  if (::fstat(file, &own) != 0) return errno;
  if (::stat(path.c_str(), &present) != 0) return errno;
  return present.st_ino == own.st_ino && present.st_dev == own.st_dev ? 0 : ENOENT;
}

}  // namespace

LogFile::LogFile(std::string path, Room room) : path_(std::move(path)), room_(std::move(room)) {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) fail(kUnwritable, error.value());
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ < 0) fail(kUnwritable, errno);
}

void LogFile::check_presence() {
  if (const int absence = absence_of(file_, path_); absence != 0) fail("is not there any more", absence);
}

void LogFile::append(std::string_view part) {
  if (room_ && !room_(bytes_ + static_cast<std::int64_t>(part.size()))) {
    end();
    throw LogError("log " + path_ +
                   " has ended: telemetry.quota is reached and no older log can be removed; another one is begun in 10 "
                   "s, then this one may be removed; "
                   "remedy: raise telemetry.quota or make room");
  }
  std::size_t done = 0;
  int error = 0;
  while (error == 0 && done < part.size()) {
    const ssize_t taken = ::write(file_, part.data() + done, part.size() - done);
    if (taken >= 0) {
      done += static_cast<std::size_t>(taken);
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  if (error == 0) {
    bytes_ += static_cast<std::int64_t>(part.size());
    return;
  }
  // A reader would misunderstand an incomplete part. A pipe cannot be cut and need not be.
  [[maybe_unused]] const int cut = ::ftruncate(file_, bytes_);
  fail(kUnwritable, error);
}

void LogFile::replace_begin(std::string_view bytes) {
  if (::pwrite(file_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    fail("cannot be completed", errno);
  }
}

void LogFile::close() {
  // Pipes and devices have nothing to synchronise.
  if (::fsync(file_) != 0 && errno != EINVAL && errno != EROFS) fail("cannot be completed", errno);
  if (::close(std::exchange(file_, -1)) != 0) fail("cannot be closed", errno);
}

void LogFile::end() noexcept {
  if (file_ >= 0) ::close(std::exchange(file_, -1));
}

void LogFile::fail(const std::string& what, int error) {
  end();
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw LogError("log " + shown_path(path_) + " " + what + ": " + std::strerror(error) +
                 (full ? "; make room or name another folder" : "; name a folder that can be written") +
                 " (telemetry.directory)");
}

}  // namespace robot_control
