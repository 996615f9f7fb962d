#pragma once
/// Reads a black box (black_box_file.h), which may be in use, cut off or damaged. The file is not trusted: it is read
/// within bounds, and damaged parts are passed over and counted.
///
/// Records begin at multiples of 8 bytes, and each has its own checksum and the sequence number of its segment. So
/// reading continues with the next sound record behind a damaged one. A record is missing at the end of a segment if
/// the first record of the next one would have fitted there. Nothing shows that a record is missing behind the newest
/// sound one.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "log/black_box/black_box_file.h"

namespace robot_control {

struct BlackBoxRecord {
  std::uint32_t kind = 0;
  std::int64_t time_ns = 0;
  std::string_view data;
};

/// Counts of written parts that cannot be read.
struct BlackBoxDamage {
  std::uint64_t segments = 0;  ///< segments without a sound record
  std::uint64_t places = 0;    ///< places in the other segments at which records are missing

  bool none() const noexcept { return segments == 0 && places == 0; }
};

class BlackBoxReader {
 public:
  /// Throws LogError if the file cannot be read, is no black box, or has a damaged head.
  explicit BlackBoxReader(const std::string& path);
  ~BlackBoxReader();
  BlackBoxReader(const BlackBoxReader&) = delete;
  BlackBoxReader& operator=(const BlackBoxReader&) = delete;

  const std::string& description() const noexcept { return description_; }

  /// True: its writer ended orderly.
  bool ended() const noexcept { return ended_; }

  /// True: a process writes it now.
  bool in_use() const noexcept;

  std::uint64_t segments() const noexcept { return segments_; }

  /// Size of the file in bytes, and the size that its head announces.
  std::uint64_t bytes() const noexcept { return bytes_; }
  std::uint64_t whole_bytes() const noexcept { return head_bytes_ + segments_ * BlackBoxFile::kSegmentBytes; }

  struct Use {
    std::function<void(const BlackBoxRecord&)> record;
    std::function<void()> gap = {};      ///< called where records are missing between two others
    std::function<void()> segment = {};  ///< called before a segment is read, which happens twice; it may throw
  };

  /// Gives every record, oldest first. A record that was overwritten meanwhile counts only if older ones were given.
  BlackBoxDamage read(const Use& use) const;

 private:
  struct Segment {
    std::uint64_t number = 0;    ///< position in the file
    std::uint64_t sequence = 0;  ///< sequence number of its newest sound record; 0: it has none
    bool written = true;         ///< false: all bytes are 0
  };
  class Walk;

  std::string load(std::uint64_t number) const;
  Segment inspect(std::uint64_t number) const;
  bool read_at(void* to, std::size_t bytes, std::uint64_t offset) const noexcept;

  int descriptor_;
  std::uint64_t bytes_ = 0;
  std::uint64_t head_bytes_ = 0;
  std::uint64_t segments_ = 0;
  bool ended_ = false;
  std::string description_;
};

}  // namespace robot_control
