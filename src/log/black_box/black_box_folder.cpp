#include "log/black_box/black_box_folder.h"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "files/descriptor.h"
#include "files/given_path.h"
#include "log/log_error.h"
#include "log/log_folder.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBag = ".bag";
constexpr const char* kRing = ".ring";

std::string prefix_of(IncidentKind kind) {
  return kind == IncidentKind::kStop ? "stop." : "crash.";
}

/// The result is true if a process writes this ring now.
bool in_use(const std::string& ring) {
  const Descriptor folder(open(ring.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return folder.open() && flock(folder.number(), LOCK_SH | LOCK_NB) != 0;
}

}  // namespace

std::string BlackBoxFolder::ring() const {
  return (fs::path(folder_) / "ring").string();
}

std::string BlackBoxFolder::name(IncidentKind kind, std::uint64_t number, const std::string& suffix) const {
  return (fs::path(folder_) / (prefix_of(kind) + std::to_string(number) + suffix)).string();
}

std::vector<BlackBoxFolder::File> BlackBoxFolder::files(IncidentKind kind, const std::string& suffix) const {
  std::vector<File> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code gone;
    const auto number = number_in(entry->path().filename().string(), prefix_of(kind), suffix);
    const fs::file_type type = suffix == kRing ? fs::file_type::directory : fs::file_type::regular;
    if (!number || entry->symlink_status(gone).type() != type) continue;
    found.push_back({.number = *number, .path = entry->path().string()});
  }
  std::ranges::sort(found, {}, &File::number);
  return found;
}

std::uint64_t BlackBoxFolder::next(IncidentKind kind) const {
  std::uint64_t newest = 0;
  for (const char* suffix : {kBag, kRing}) {
    for (const File& file : files(kind, suffix)) newest = std::max(newest, file.number);
  }
  return newest + 1;
}

void BlackBoxFolder::remove_oldest(IncidentKind kind) const {
  std::vector<File> all = files(kind, kBag);
  std::ranges::copy(files(kind, kRing), std::back_inserter(all));
  std::ranges::sort(all, {}, &File::number);
  std::error_code ignored;
  for (std::size_t i = 0; i + keep_ < all.size(); ++i) fs::remove_all(all[i].path, ignored);
}

void BlackBoxFolder::put_ring_aside() {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) {
    throw LogError("black box " + file_error(folder_, failed("created", error.value())) +
                   "; set a folder that can be written (telemetry.directory)");
  }
  if (in_use(ring())) {
    throw LogError("black box " + ring() +
                   " is written by another telemetry; name another folder (telemetry.directory)");
  }
  // A telemetry that was killed while it saved an incident leaves such a folder.
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == kSavingSuffix) fs::remove_all(entry->path(), error);
  }
  if (!fs::exists(fs::symlink_status(ring(), error))) return;
  const bool crash = keep_ != 0 && fs::is_directory(ring(), error) && !fs::exists(fs::path(ring()) / kEndedMark, error);
  const std::string before = ring() + ".before";
  if (!crash) fs::remove_all(before, error);
  fs::rename(ring(), crash ? name(IncidentKind::kCrash, next(IncidentKind::kCrash), kRing) : before, error);
  if (error) {
    throw LogError("black box " + ring() + " of an earlier run cannot be renamed: " + error.message() +
                   "; name a folder that can be written (telemetry.directory)");
  }
  if (crash) remove_oldest(IncidentKind::kCrash);
}

std::vector<std::string> BlackBoxFolder::unsaved() const {
  std::vector<std::string> paths;
  for (const File& file : files(IncidentKind::kCrash, kRing)) paths.push_back(file.path);
  return paths;
}

SavedIncident BlackBoxFolder::save(const std::string& ring, IncidentKind kind, const GiveUp& give_up) const {
  const auto number = number_in(fs::path(ring).filename().string(), prefix_of(kind), kRing);
  const std::string bag = name(kind, number.value_or(next(kind)), kBag);
  const SavedBlackBox saved = save_black_box(ring, bag, give_up);
  std::error_code ignored;
  if (number) fs::remove_all(ring, ignored);
  remove_oldest(kind);
  return {.bag = bag, .missing = saved.missing};
}

}  // namespace robot_control
