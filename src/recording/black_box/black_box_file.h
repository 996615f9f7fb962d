#pragma once
/// The last messages before a crash: a ring of records in a file of fixed size that is mapped into memory.
///
/// What is stored in the mapping belongs to the kernel: it survives the end of the process by any signal, and reaches
/// the disk with the next writeback (a kernel panic loses what was not written back, some 30 s). The space is reserved
/// at the start, so that no store meets a full disk (SIGBUS); file systems that copy on write may need more (btrfs,
/// ZFS). For one ordinary thread: a store may fault a page in.
///
///   file     = head (magic, sizes, `description`; whole MiB) + segments of equal size
///   segment  = records, one behind the other; each lap of the ring gives it the next sequence number
///   record   = {checksum, sequence of its segment, time, kind, length} + data, padded to 8 bytes
///
/// The file is locked while it is written: the lock of a process that is killed ends with it. An orderly end is marked
/// in the head.
///
/// A record counts only where checksum and sequence agree: one that was cut off by SIGKILL, or that is left of the lap
/// before, does not. The newest (segments − 1) · segment bytes are always there. Reader: black_box_reader.h.

#include <cstdint>
#include <string>
#include <string_view>

namespace robot_control {

class BlackBoxFile {
 public:
  static constexpr std::size_t kSegmentBytes = std::size_t{1} << 20U;

  /// A new file with room for the newest `bytes` of records. Throws LogError: it cannot be made, or the disk
  /// has no room; then nothing is left of it.
  BlackBoxFile(const std::string& path, std::size_t bytes, std::string_view description);
  ~BlackBoxFile();
  BlackBoxFile(const BlackBoxFile&) = delete;
  BlackBoxFile& operator=(const BlackBoxFile&) = delete;

  /// At most kSegmentBytes − 64 bytes; more is refused: false.
  bool append(std::uint32_t kind, std::int64_t time_ns, std::string_view data) noexcept;

  /// The end is orderly, nothing is appended any more.
  void mark_ended() noexcept;

  /// The file is where it was made: it was not removed, nor another one put there.
  bool at_its_path() const noexcept;

  /// Of records, since the beginning; and of the newest, how many are always there.
  std::uint64_t appended_bytes() const noexcept { return (sequence_ - 1) * kSegmentBytes + at_; }
  std::uint64_t kept_bytes() const noexcept { return (segments_ - 1) * kSegmentBytes; }

 private:
  std::string path_;
  int descriptor_;  // holds the lock
  char* memory_ = nullptr;
  std::size_t size_ = 0;
  std::size_t head_bytes_ = 0;
  std::uint64_t segments_ = 0;
  std::uint64_t sequence_ = 1;  // of the segment that is written
  std::size_t at_ = 0;          // in it
};

}  // namespace robot_control
