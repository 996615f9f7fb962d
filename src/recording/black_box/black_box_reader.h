#pragma once
/// Reads a black box (black_box_file.h), which may be in use, cut off or damaged. It comes from outside: it is read
/// with bounds, and whatever is not sound is passed over and counted.
///
/// Records begin at multiples of 8 bytes, and each has its own checksum and the sequence number of its segment. So
/// reading goes on with the next sound record behind a damaged one. What is missing at the end of a segment shows in
/// the next one: its first record would have had room. What is missing behind the newest sound record cannot be
/// distinguished from what was not written any more.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/black_box/black_box_file.h"

namespace robot_control {

struct BlackBoxRecord {
  std::uint32_t kind = 0;
  std::int64_t time_ns = 0;
  std::string_view data;
};

/// What is not there though it was written.
struct BlackBoxDamage {
  std::uint64_t segments = 0;  ///< without a sound record
  std::uint64_t places = 0;    ///< in the others, where records are missing

  bool none() const noexcept { return segments == 0 && places == 0; }
};

class BlackBoxReader {
 public:
  /// Throws LogError: it cannot be read, or is no black box, or its head is damaged or cut off.
  explicit BlackBoxReader(const std::string& path);
  ~BlackBoxReader();
  BlackBoxReader(const BlackBoxReader&) = delete;
  BlackBoxReader& operator=(const BlackBoxReader&) = delete;

  const std::string& description() const noexcept { return description_; }

  /// By an orderly end of its writer.
  bool ended() const noexcept { return ended_; }

  /// A process writes it now.
  bool in_use() const noexcept;

  std::uint64_t segments() const noexcept { return segments_; }

  /// Bytes of the file, and how many its head announces.
  std::uint64_t bytes() const noexcept { return bytes_; }
  std::uint64_t whole_bytes() const noexcept { return head_bytes_ + segments_ * BlackBoxFile::kSegmentBytes; }

  struct Use {
    std::function<void(const BlackBoxRecord&)> record;
    std::function<void()> gap = {};      ///< between the record before and the one after, others are missing
    std::function<void()> segment = {};  ///< before one is read, which happens twice; it may throw, as the others
  };

  /// Gives every record, oldest first. What was written again while it was read is missing only between others.
  BlackBoxDamage read(const Use& use) const;

 private:
  struct Segment {
    std::uint64_t number = 0;    ///< in the file
    std::uint64_t sequence = 0;  ///< the newest of its sound records; 0: it has none
    bool written = true;         ///< false: all bytes are 0
  };
  class Walk;

  std::string load(std::uint64_t number) const;
  Segment look(std::uint64_t number) const;
  bool read_at(void* to, std::size_t bytes, std::uint64_t offset) const noexcept;

  int descriptor_;
  std::uint64_t bytes_ = 0;
  std::uint64_t head_bytes_ = 0;
  std::uint64_t segments_ = 0;
  bool ended_ = false;
  std::string description_;
};

}  // namespace robot_control
