#include "telemetry/log_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string_view>
#include <system_error>

#include "telemetry/log_error.h"
#include "telemetry/numbered_name.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

/// Bytes that a bag begins with. Where there was nothing to record until SIGKILL, it has no more.
constexpr std::uintmax_t kBagWithoutMessage = 4117;

constexpr std::string_view kBegin = "run.";
constexpr std::array kKinds{LogKind::kCsv, LogKind::kBag};

std::string_view suffix_of(LogKind kind) {
  return kind == LogKind::kCsv ? ".csv" : ".bag";
}

}  // namespace

LogFolder::LogFolder(const std::string& directory, std::int64_t quota) : directory_(directory), quota_(quota) {
  look();
}

LogFolder::~LogFolder() {
  if (lock_ >= 0) close(lock_);
}

/// Again where the folder was removed and another one was made.
void LogFolder::lock() {
  const std::string directory = directory_.empty() ? "." : directory_;
  std::error_code error;
  fs::create_directories(directory, error);  // an error shows when the log is opened
  const int descriptor = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat own {};
  struct stat there {};
  const bool same = lock_ >= 0 && fstat(lock_, &own) == 0 && fstat(descriptor, &there) == 0 &&
                    own.st_ino == there.st_ino && own.st_dev == there.st_dev;
  const bool taken = !same && flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (same || taken) close(descriptor);
  if (taken) {
    throw LogError("folder " + directory +
                   " is used by another telemetry, which writes its logs there; name another one "
                   "(telemetry.directory)");
  }
  if (same) return;
  if (lock_ >= 0) close(lock_);
  lock_ = descriptor;
}

void LogFolder::look() {
  kept_.clear();
  kept_bytes_ = 0;
  std::error_code error;
  for (fs::directory_iterator entry(directory_.empty() ? "." : directory_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code gone;
    if (!fs::is_regular_file(entry->symlink_status(gone))) continue;
    for (const LogKind kind : kKinds) {
      const auto number = number_in(name, kBegin, suffix_of(kind));
      const std::uintmax_t bytes = number ? entry->file_size(gone) : 0;
      if (!number || gone) continue;
      kept_.push_back({.number = *number, .kind = kind, .bytes = static_cast<std::int64_t>(bytes)});
      kept_bytes_ += kept_.back().bytes;
    }
  }
  std::ranges::sort(kept_, std::greater{}, &Kept::number);
}

std::string LogFolder::name(std::uint64_t number, LogKind kind) const {
  const std::string file = std::string(kBegin) + std::to_string(number) + std::string(suffix_of(kind));
  return (fs::path(directory_) / file).string();
}

std::string LogFolder::path(LogKind kind) const {
  return (fs::path(directory_) / ("run" + std::string(suffix_of(kind)))).string();
}

std::string LogFolder::begin(LogKind kind) {
  lock();
  const std::string path = this->path(kind);
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  const bool empty = !error && (bytes == 0 || (kind == LogKind::kBag && bytes == kBagWithoutMessage));
  if (!empty && fs::is_regular_file(fs::symlink_status(path, error))) {
    const std::string kept = name(kept_.empty() ? 1 : kept_.front().number + 1, kind);
    fs::rename(path, kept, error);
    if (error) {
      throw LogError("log " + path + " of an earlier run cannot be renamed to " + kept + ": " + error.message() +
                     "; name a folder that can be written (telemetry.directory)");
    }
    look();
  }
  running_[static_cast<std::size_t>(kind)] = 0;
  return path;
}

bool LogFolder::make_room(LogKind kind, std::int64_t bytes) {
  running_[static_cast<std::size_t>(kind)] = bytes;
  if (quota_ == 0) return true;
  const bool beside_bag = kind == LogKind::kCsv && running_[static_cast<std::size_t>(LogKind::kBag)] > 0;
  if (beside_bag && bytes > quota_ / 2) return false;
  const std::int64_t running = std::accumulate(running_.begin(), running_.end(), std::int64_t{0});
  if (running > quota_) return false;
  while (kept_bytes_ + running > quota_ && !kept_.empty()) {
    const std::string oldest = name(kept_.back().number, kept_.back().kind);
    std::error_code error;
    fs::remove(oldest, error);
    if (error) return false;
    removed_.push_back(oldest);
    kept_bytes_ -= kept_.back().bytes;
    kept_.pop_back();
  }
  return true;
}

}  // namespace robot_control
