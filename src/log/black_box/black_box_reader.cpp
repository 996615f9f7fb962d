#include "log/black_box/black_box_reader.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "log/black_box/black_box_layout.h"

namespace robot_control {

using namespace black_box_layout;

namespace {

struct Found {
  RecordHead head;
  std::string_view data;
  std::size_t end;  ///< end of the record in the segment
};

/// The sound record that begins at `at`, whatever its sequence number.
std::optional<Found> record_at(std::string_view segment, std::size_t at) {
  Found found;
  if (at + sizeof found.head > segment.size()) return {};
  std::memcpy(&found.head, segment.data() + at, sizeof found.head);
  if (found.head.sequence == 0 || found.head.length > segment.size() - at - sizeof found.head) return {};
  found.data = segment.substr(at + sizeof found.head, found.head.length);
  found.end = at + sizeof found.head + padded(found.head.length);
  if (checksum_of(found.head, found.data) != found.head.checksum) return {};
  return found;
}

/// The sequence number of the record that begins at `at`, sound or not.
std::uint64_t sequence_at(std::string_view segment, std::size_t at) {
  RecordHead head;
  if (at + sizeof head > segment.size()) return 0;
  std::memcpy(&head, segment.data() + at, sizeof head);
  return head.sequence;
}

}  // namespace

BlackBoxReader::BlackBoxReader(const std::string& path)
    : descriptor_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
  if (descriptor_ < 0) fail(path, std::strerror(errno));
  constexpr std::uint64_t kMaxSegments = 1U << 17U;
  constexpr std::uint64_t kMaxHeadBytes = 1U << 28U;
  struct stat status {};
  Head head{};
  const bool regular = fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  const bool known = regular && read_at(&head, sizeof head, 0) && std::memcmp(head.magic, kMagic, sizeof kMagic) == 0 &&
                     head.segments >= 2 && head.segments <= kMaxSegments && head.head_bytes >= sizeof head &&
                     head.head_bytes <= kMaxHeadBytes && head.description_bytes <= head.head_bytes - sizeof head;
  if (known) {
    bytes_ = static_cast<std::uint64_t>(status.st_size);
    head_bytes_ = head.head_bytes;
    segments_ = head.segments;
    ended_ = head.ended != 0;
    description_.resize(head.description_bytes);
  }
  const bool whole = known && read_at(description_.data(), description_.size(), sizeof head);
  if (whole && checksum_of(head, description_) == head.checksum) return;
  close(descriptor_);
  if (!known) fail(path, "is no black box of this version; name the file black_box/ring in the folder of the logs");
  if (whole) fail(path, "is damaged in its head, in the first " + std::to_string(head.head_bytes) + " bytes");
  fail(path, "is cut off within its head: " + std::to_string(bytes_) + " of " + std::to_string(whole_bytes()) +
                 " bytes are there, and nothing of it can be read");
}

BlackBoxReader::~BlackBoxReader() {
  close(descriptor_);
}

bool BlackBoxReader::in_use() const noexcept {
  if (flock(descriptor_, LOCK_SH | LOCK_NB) != 0) return true;
  flock(descriptor_, LOCK_UN);
  return false;
}

bool BlackBoxReader::read_at(void* to, std::size_t bytes, std::uint64_t offset) const noexcept {
  return pread(descriptor_, to, bytes, static_cast<off_t>(offset)) == static_cast<ssize_t>(bytes);
}

/// As much of it as there is.
std::string BlackBoxReader::load(std::uint64_t number) const {
  std::string segment(BlackBoxFile::kSegmentBytes, '\0');
  const auto offset = static_cast<off_t>(head_bytes_ + number * BlackBoxFile::kSegmentBytes);
  const ssize_t got = pread(descriptor_, segment.data(), segment.size(), offset);
  segment.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return segment;
}

/// The newest sequence number of its sound records: that of the first, unless that is damaged.
BlackBoxReader::Segment BlackBoxReader::inspect(std::uint64_t number) const {
  Segment result{.number = number};
  const std::string segment = load(number);
  const auto consider = [&](std::size_t at) {
    const std::uint64_t sequence = sequence_at(segment, at);
    if (sequence <= result.sequence || sequence % segments_ != number || !record_at(segment, at)) return;
    result.sequence = sequence;
  };
  consider(0);
  if (result.sequence != 0) return result;
  for (std::size_t at = kAlignment; at < segment.size(); at += kAlignment) consider(at);
  result.written = std::ranges::any_of(segment, [](char byte) { return byte != 0; });
  return result;
}

/// Walks from record to record, oldest first.
class BlackBoxReader::Walk {
 public:
  /// In the first lap nothing is overwritten, so that the oldest record is the first one.
  Walk(const Use& use, BlackBoxDamage& damage, bool first_lap) : use_(use), damage_(damage), first_lap_(first_lap) {}

  void read(const Segment& place, std::string_view segment) {
    check_end_before(place, segment);
    bool any = false;
    for (std::size_t at = 0; at + sizeof(RecordHead) <= segment.size();) {
      const auto found = sequence_at(segment, at) == place.sequence ? record_at(segment, at) : std::nullopt;
      if (!found) {
        at += kAlignment;
        continue;
      }
      if (at != (any ? end_ : 0)) miss_here();
      give(*found);
      any = true;
      at = end_ = found->end;
    }
    if (any) {
      sequence_ = place.sequence;
      return;
    }
    // The segment was overwritten meanwhile: that counts only if older records were given before.
    const bool newer = sequence_at(segment, 0) > place.sequence && record_at(segment, 0);
    if (!newer || given_) ++damage_.segments;
  }

 private:
  void give(const Found& found) {
    if (gap_ && given_ && use_.gap) use_.gap();
    gap_ = false;
    given_ = true;
    use_.record({.kind = found.head.kind, .time_ns = found.head.time_ns, .data = found.data});
  }
  void miss_here() {
    if (!given_ && !first_lap_) return;
    ++damage_.places;
    gap_ = true;
  }

  /// The writer leaves a segment where the next record has no room.
  void check_end_before(const Segment& place, std::string_view segment) {
    if (!given_) return;
    if (place.sequence != sequence_ + 1) {
      gap_ = true;  // the segments between them are counted elsewhere
      return;
    }
    const auto first = sequence_at(segment, 0) == place.sequence ? record_at(segment, 0) : std::nullopt;
    if (first && end_ + first->end <= BlackBoxFile::kSegmentBytes) miss_here();
  }

  const Use& use_;
  BlackBoxDamage& damage_;
  bool first_lap_;
  bool given_ = false;
  bool gap_ = false;
  std::uint64_t sequence_ = 0;  ///< sequence number of the segment before
  std::size_t end_ = 0;         ///< end of its last sound record
};

BlackBoxDamage BlackBoxReader::read(const Use& use) const {
  std::vector<Segment> all;
  std::uint64_t newest = 0;
  for (std::uint64_t i = 0; i < segments_; ++i) {
    if (use.segment) use.segment();
    all.push_back(inspect(i));
    newest = std::max(newest, all.back().sequence);
  }
  // The newest `segments_` sequence numbers are written; a lower one belongs to the lap before.
  BlackBoxDamage damage;
  std::vector<Segment> sound;
  for (const Segment& each : all) {
    const std::uint64_t back = (newest % segments_ + segments_ - each.number) % segments_;
    const std::uint64_t expected = newest - std::min(newest, back);
    if (expected != 0 && each.sequence == expected) {
      sound.push_back(each);
    } else if (expected != 0 || each.written) {
      ++damage.segments;
    }
  }
  std::ranges::sort(sound, {}, &Segment::sequence);
  Walk walk(use, damage, newest < segments_);
  for (const Segment& each : sound) {
    if (use.segment) use.segment();
    walk.read(each, load(each.number));
  }
  return damage;
}

}  // namespace robot_control
