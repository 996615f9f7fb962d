#include "log/black_box/black_box.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "log/black_box/black_box_folder.h"
#include "log/log_error.h"

namespace robot_control {
namespace {

constexpr std::size_t kChunkBytes = 1 << 18;  // uncompressed size at which a chunk ends early

bool is_at(int descriptor, const std::string& path) noexcept {
  struct stat own {};
  struct stat present {};
  return fstat(descriptor, &own) == 0 && stat(path.c_str(), &present) == 0 && own.st_ino == present.st_ino &&
         own.st_dev == present.st_dev;
}

std::string name_of(std::size_t bag) {
  return std::to_string(bag) + ".bag";
}

}  // namespace

BlackBox::BlackBox(const std::string& folder, std::size_t bytes, const LogHeader& header)
    : folder_(folder),
      lock_(-1),
      header_(header),
      join_(
          header.period, [this](const JoinedRow& row) { write(row); }, std::numeric_limits<std::size_t>::max()),
      window_(static_cast<std::size_t>(std::ceil(kWindow / header.period))) {
  header_.record = "always";
  header_.part = 0;
  constexpr std::size_t kMaxBags = 1000;
  bag_bytes_ = std::max({kBagBytes, 4 * encode(header_).size(), bytes / kMaxBags});
  bags_ = (bytes + bag_bytes_ - 1) / bag_bytes_ + 1;
  if (mkdir(folder.c_str(), 0700) == 0) lock_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw LogError(folder + ": " + std::strerror(errno));
  flock(lock_, LOCK_EX | LOCK_NB);
  make_bags();
}

void BlackBox::make_bags() {
  for (std::size_t i = 0; i < bags_; ++i) {
    const int bag = openat(lock_, name_of(i).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    const int problem = bag < 0 ? errno : posix_fallocate(bag, 0, static_cast<off_t>(bag_bytes_));
    if (bag >= 0) close(bag);
    if (problem == 0) continue;
    close(lock_);
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
    throw LogError(folder_ + ": there is no room for the black box of " +
                   std::to_string(bags_ * bag_bytes_ / 1'000'000) + " MB: " + std::strerror(problem) +
                   "; make room, or set telemetry.black_box to 0 or telemetry.directory");
  }
}

BlackBox::~BlackBox() {
  if (bag_ >= 0) close(bag_);
  close(lock_);
}

void BlackBox::set_state(std::int64_t time_offset_ns, std::uint64_t lost) noexcept {
  chunk_.set_time_offset(time_offset_ns);
  lost_ = lost;
}

void BlackBox::set_header(const LogHeader& header) {
  const std::uint32_t part = header_.part;
  header_ = header;
  header_.record = "always";
  header_.part = part;
  at_ = bag_bytes_;  // the next chunk begins another bag
}

void BlackBox::write(const JoinedRow& row) {
  const std::int64_t stamp_ns = stamp_of(row);
  newest_ns_ = std::max(newest_ns_, stamp_ns);
  if (first_ns_ == 0) first_ns_ = stamp_ns;
  chunk_.add(row, lost_, header_.joints.size());
  if (chunk_.size() >= kChunkBytes) write_chunk();
}

void BlackBox::flush() {
  join_.emit_beyond(window_);
  write_chunk();
}

void BlackBox::write_chunk() {
  if (chunk_.empty()) return;
  const std::int64_t begin_ns = chunk_.begin_ns();
  const PackedChunk chunk = chunk_.pack(Effort::kFast);
  const std::string bytes = chunk.record + chunk.index;
  if (begun_ == 0 || at_ + bytes.size() > bag_bytes_) failed_ = !begin_bag(begin_ns) || failed_;
  failed_ = !append(bytes) || failed_;
}

/// A bag that is read meanwhile, or that a kill leaves incomplete, begins with zeros or holds an incomplete chunk.
bool BlackBox::begin_bag(std::int64_t time_ns) {
  const bool again = begun_ >= bags_;
  if (bag_ >= 0) close(bag_);
  bag_ = openat(lock_, name_of(begun_++ % bags_).c_str(), O_WRONLY | O_CLOEXEC);
  at_ = 0;
  static const std::string zeros(1 << 16, '\0');
  for (std::size_t at = 0; again && at < bag_bytes_; at += zeros.size()) {
    if (!append(std::string_view(zeros).substr(0, bag_bytes_ - at))) return false;
  }
  at_ = 0;
  const PackedChunk first = first_chunk(header_, time_ns);
  ++header_.part;
  return append(bag_opening(0, log_connections().size(), 0) + first.record + first.index);
}

bool BlackBox::append(std::string_view bytes) {
  if (at_ + bytes.size() > bag_bytes_) return false;
  while (!bytes.empty()) {
    const ssize_t taken = pwrite(bag_, bytes.data(), bytes.size(), static_cast<off_t>(at_));
    if (taken < 0 && errno == EINTR) continue;
    if (taken <= 0) return false;
    at_ += static_cast<std::size_t>(taken);
    bytes.remove_prefix(static_cast<std::size_t>(taken));
  }
  return true;
}

void BlackBox::finish() {
  join_.finish();
  write_chunk();
}

void BlackBox::mark_ended() const noexcept {
  const int mark = openat(lock_, kEndedMark, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (mark >= 0) close(mark);
}

bool BlackBox::sound() const noexcept {
  const bool present = bag_ < 0 || is_at(bag_, folder_ + "/" + name_of((begun_ - 1) % bags_));
  return !failed_ && present && is_at(lock_, folder_);
}

double BlackBox::seconds_held() const noexcept {
  if (begun_ == 0) return 0;
  const double written = static_cast<double>((begun_ - 1) * bag_bytes_ + at_);
  return seconds_added() * static_cast<double>((bags_ - 1) * bag_bytes_) / written;
}

}  // namespace robot_control
