#include "log/black_box/black_box.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "files/given_path.h"
#include "log/black_box/black_box_folder.h"
#include "log/log_error.h"

namespace robot_control {
namespace {

constexpr std::size_t kChunkBytes = 1 << 18;  // uncompressed size at which a chunk ends early

std::string name_of(std::size_t bag) {
  return std::to_string(bag) + ".bag";
}

}  // namespace

BlackBox::BlackBox(const std::string& folder, std::size_t bytes, const LogHeader& header)
    : folder_(folder),
      header_(header),
      join_(
          header.period, [this](const JoinedRow& row) { write(row); }, std::numeric_limits<std::size_t>::max()),
      window_(static_cast<std::size_t>(std::ceil(kWindow / header.period))) {
  header_.record = "always";
  header_.part = 0;
  constexpr std::size_t kMaxBags = 1000;
  bag_bytes_ = std::max({kBagBytes, 4 * encode(header_).size(), bytes / kMaxBags});
  bags_ = (bytes + bag_bytes_ - 1) / bag_bytes_ + 1;
  if (mkdir(folder.c_str(), 0700) == 0) lock_ = Descriptor(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!lock_.open()) throw LogError(file_error(folder, failed("created", errno)));
  flock(lock_.number(), LOCK_EX | LOCK_NB);
  make_bags();
}

void BlackBox::make_bags() {
  for (std::size_t i = 0; i < bags_; ++i) {
    const Descriptor bag(openat(lock_.number(), name_of(i).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    const int problem = bag.open() ? posix_fallocate(bag.number(), 0, static_cast<off_t>(bag_bytes_)) : errno;
    if (problem == 0) continue;
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
    throw LogError(folder_ + ": there is no room for the black box of " +
                   std::to_string(bags_ * bag_bytes_ / 1'000'000) + " MB: " + std::strerror(problem) +
                   "; remove files, or set telemetry.black_box to 0 or telemetry.directory");
  }
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
  bag_ = Descriptor(openat(lock_.number(), name_of(begun_++ % bags_).c_str(), O_WRONLY | O_CLOEXEC));
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
  if (at_ + bytes.size() > bag_bytes_ || bag_.write(bytes, static_cast<off_t>(at_)) != 0) return false;
  at_ += bytes.size();
  return true;
}

void BlackBox::finish() {
  join_.finish();
  write_chunk();
}

void BlackBox::mark_ended() const noexcept {
  const Descriptor mark(openat(lock_.number(), kEndedMark, O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
}

bool BlackBox::sound() const noexcept {
  const bool present = !bag_.open() || bag_.absence_from(folder_ + "/" + name_of((begun_ - 1) % bags_)) == 0;
  return !failed_ && present && lock_.absence_from(folder_) == 0;
}

double BlackBox::seconds_held() const noexcept {
  if (begun_ == 0) return 0;
  const double written = static_cast<double>((begun_ - 1) * bag_bytes_ + at_);
  return seconds_added() * static_cast<double>((bags_ - 1) * bag_bytes_) / written;
}

}  // namespace robot_control
