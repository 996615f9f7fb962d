#include "log/log_folder.h"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <functional>
#include <system_error>

#include "log/log_error.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

/// A bag begins with so many bytes. It has no more where nothing was recorded before SIGKILL.
constexpr std::uintmax_t kBagWithoutMessage = 4117;

constexpr std::string_view kPrefix = "run.";
constexpr std::string_view kSuffix = ".bag";

}  // namespace

LogFolder::LogFolder(const std::string& directory, std::int64_t quota) : directory_(directory), quota_(quota) {
  list_kept();
}

/// A folder that was removed and made again is locked again.
void LogFolder::lock() {
  const std::string directory = directory_.empty() ? "." : directory_;
  std::error_code error;
  fs::create_directories(directory, error);  // an error shows when the log is opened
  if (lock_.open() && lock_.absence_from(directory) == 0) return;
  Descriptor folder(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder.open()) return;
  if (flock(folder.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw LogError("folder " + directory +
                   " is used by another telemetry, which writes its logs there; name another one "
                   "(telemetry.directory)");
  }
  lock_ = std::move(folder);
}

void LogFolder::list_kept() {
  kept_.clear();
  kept_bytes_ = 0;
  std::error_code error;
  for (fs::directory_iterator entry(directory_.empty() ? "." : directory_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code gone;
    if (!fs::is_regular_file(entry->symlink_status(gone))) continue;
    const auto number = number_in(name, kPrefix, kSuffix);
    const std::uintmax_t bytes = number ? entry->file_size(gone) : 0;
    if (!number || gone) continue;
    kept_.push_back({.number = *number, .bytes = static_cast<std::int64_t>(bytes)});
    kept_bytes_ += kept_.back().bytes;
  }
  std::ranges::sort(kept_, std::greater{}, &Kept::number);
}

std::string LogFolder::name(std::uint64_t number) const {
  const std::string file = std::string(kPrefix) + std::to_string(number) + std::string(kSuffix);
  return (fs::path(directory_) / file).string();
}

std::string LogFolder::path() const {
  return (fs::path(directory_) / "run.bag").string();
}

std::string LogFolder::begin() {
  lock();
  const std::string path = this->path();
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  const bool empty = !error && (bytes == 0 || bytes == kBagWithoutMessage);
  if (!empty && fs::is_regular_file(fs::symlink_status(path, error))) {
    const std::string kept = name(kept_.empty() ? 1 : kept_.front().number + 1);
    fs::rename(path, kept, error);
    if (error) {
      throw LogError("log " + path + " of an earlier run cannot be renamed to " + kept + ": " + error.message() +
                     "; name a folder that can be written (telemetry.directory)");
    }
    list_kept();
  }
  return path;
}

bool LogFolder::make_room(std::int64_t bytes) {
  if (quota_ == 0) return true;
  if (bytes > quota_) return false;
  while (kept_bytes_ + bytes > quota_ && !kept_.empty()) {
    const std::string oldest = name(kept_.back().number);
    std::error_code error;
    fs::remove(oldest, error);
    if (error) return false;
    removed_.push_back(oldest);
    kept_bytes_ -= kept_.back().bytes;
    kept_.pop_back();
  }
  return true;
}

std::optional<std::uint64_t> number_in(std::string_view name, std::string_view prefix,
                                       std::string_view suffix) noexcept {
  if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) || !name.ends_with(suffix)) return {};
  const char* const last = name.data() + name.size() - suffix.size();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(name.data() + prefix.size(), last, number);
  if (error != std::errc() || end != last) return {};
  return number;
}

}  // namespace robot_control
