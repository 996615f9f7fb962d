#pragma once
/// The last records before a crash are in a ring, in a file of fixed size that is mapped into memory.
///
/// The kernel owns the mapping: its contents survive the end of the process by any signal. They reach the disk with the
/// next writeback; a kernel panic loses those of the last 30 s. The space is reserved at the start, so that no store
/// meets a full disk (SIGBUS). The process keeps only the segment in memory to which it writes.
/// The kernel has the others in its page cache, and gives them up when memory is short. File systems that copy on
/// write (btrfs, ZFS) may need more. Only one ordinary thread may write, because a store may fault a page in.
///
///   file     = head (magic, sizes, `description`; whole MiB) + segments of equal size
///   segment  = records, one behind the other; each lap of the ring gives it the next sequence number
///   record   = {checksum, sequence of its segment, time, kind, length} + data, padded to 8 bytes
///
/// The file is locked while it is written; the lock of a killed process ends with it. An orderly end is marked in the
/// head.
///
/// A record counts only if checksum and sequence agree. A record that SIGKILL cut off, or of the lap before, does not
/// count. The newest (segments − 1) · segment bytes are always present. black_box_reader.h reads the file.

#include <cstdint>
#include <string>
#include <string_view>

namespace robot_control {

class BlackBoxFile {
 public:
  static constexpr std::size_t kSegmentBytes = std::size_t{1} << 20U;

  /// Makes a file with room for the newest `bytes` of records. Throws LogError if it cannot be made, or if the disk has
  /// no room; then nothing is left of it.
  BlackBoxFile(const std::string& path, std::size_t bytes, std::string_view description);
  ~BlackBoxFile();
  BlackBoxFile(const BlackBoxFile&) = delete;
  BlackBoxFile& operator=(const BlackBoxFile&) = delete;

  /// `data` has at most kSegmentBytes − 64 bytes; false: it has more and is refused.
  bool append(std::uint32_t kind, std::int64_t time_ns, std::string_view data) noexcept;

  /// Marks an orderly end; nothing may be appended afterwards.
  void mark_ended() noexcept;

  /// True: the file is still at its path; it was neither removed nor replaced.
  bool at_its_path() const noexcept;

  /// Bytes of records since the beginning, and of the newest ones that are always present.
  std::uint64_t appended_bytes() const noexcept { return (sequence_ - 1) * kSegmentBytes + at_; }
  std::uint64_t kept_bytes() const noexcept { return (segments_ - 1) * kSegmentBytes; }

 private:
  /// Takes this part out of the memory of the process; its contents stay in the file.
  void give_back(std::size_t begin, std::size_t bytes) noexcept;

  std::string path_;
  int descriptor_;  ///< holds the lock
  char* memory_ = nullptr;
  std::size_t size_ = 0;
  std::size_t head_bytes_ = 0;
  std::uint64_t segments_ = 0;
  std::uint64_t sequence_ = 1;  ///< sequence number of the segment that is written
  std::size_t at_ = 0;          ///< position in it
};

}  // namespace robot_control
