#include "log/log_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/given_path.h"
#include "log/log_error.h"

namespace robot_control {
LogFile::LogFile(std::string path, Room room) : path_(std::move(path)), room_(std::move(room)) {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) fail(kUnwritable, error.value());
  file_ = Descriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (!file_.open()) fail(kUnwritable, errno);
}

void LogFile::check_presence() {
  if (const int absence = file_.absence_from(path_); absence != 0) fail("is not there any more", absence);
}

void LogFile::append(std::string_view part) {
  if (room_ && !room_(bytes_ + static_cast<std::int64_t>(part.size()))) {
    file_.close();
    throw LogError("log " + path_ +
                   " has ended: telemetry.quota is reached and no older log can be removed; another one is begun in 10 "
                   "s, then this one may be removed; "
                   "remedy: raise telemetry.quota or make room");
  }
  const int error = file_.write(part);
  if (error == 0) {
    bytes_ += static_cast<std::int64_t>(part.size());
    return;
  }
  // A reader would misunderstand an incomplete part. A pipe cannot be cut and need not be.
  [[maybe_unused]] const int cut = ::ftruncate(file_.number(), bytes_);
  fail(kUnwritable, error);
}

void LogFile::replace_begin(std::string_view bytes) {
  if (const int error = file_.write(bytes, 0); error != 0) fail("cannot be completed", error);
}

void LogFile::close() {
  // Pipes and devices have nothing to synchronise.
  if (::fsync(file_.number()) != 0 && errno != EINVAL && errno != EROFS) fail("cannot be completed", errno);
  if (file_.close() != 0) fail("cannot be closed", errno);
}

void LogFile::fail(const std::string& what, int error) {
  file_.close();
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw LogError("log " + shown_path(path_) + " " + what + ": " + std::strerror(error) +
                 (full ? "; make room or name another folder" : "; name a folder that can be written") +
                 " (telemetry.directory)");
}

}  // namespace robot_control
