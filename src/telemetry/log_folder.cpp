#include "telemetry/log_folder.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <system_error>

#include "telemetry/csv_writer.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

/// N of "run.N.csv".
std::optional<std::uint64_t> number_of(const std::string& name) {
  constexpr std::string_view kBegin = "run.";
  constexpr std::string_view kEnd = ".csv";
  if (name.size() <= kBegin.size() + kEnd.size() || !name.starts_with(kBegin) || !name.ends_with(kEnd)) return {};
  const char* const first = name.data() + kBegin.size();
  const char* const last = name.data() + name.size() - kEnd.size();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || end != last) return {};
  return number;
}

}  // namespace

LogFolder::LogFolder(const std::string& directory, std::int64_t quota) : directory_(directory), quota_(quota) {
  look();
}

void LogFolder::look() {
  kept_.clear();
  kept_bytes_ = 0;
  std::error_code error;
  for (fs::directory_iterator entry(directory_.empty() ? "." : directory_, error), end; !error && entry != end;
       entry.increment(error)) {
    const auto number = number_of(entry->path().filename().string());
    std::error_code gone;
    if (!number || !fs::is_regular_file(entry->symlink_status(gone))) continue;
    const std::uintmax_t bytes = entry->file_size(gone);
    if (gone) continue;
    kept_.push_back({.number = *number, .bytes = static_cast<std::int64_t>(bytes)});
    kept_bytes_ += kept_.back().bytes;
  }
  std::ranges::sort(kept_, std::greater{}, &Kept::number);
}

std::string LogFolder::name(std::uint64_t number) const {
  return (fs::path(directory_) / ("run." + std::to_string(number) + ".csv")).string();
}

std::string LogFolder::begin() {
  const std::string path = (fs::path(directory_) / "run.csv").string();
  std::error_code error;
  if (fs::is_regular_file(fs::symlink_status(path, error))) {
    const std::string kept = name(kept_.empty() ? 1 : kept_.front().number + 1);
    fs::rename(path, kept, error);
    if (error) {
      throw LogError("log " + path + " of an earlier run cannot be renamed to " + kept + ": " + error.message() +
                     "; name a folder that can be written (telemetry.directory)");
    }
    look();
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

}  // namespace robot_control
