#pragma once
/// The file that keeps a latched stop over a reboot: parameter safety_monitor/latch_file.
///
///   causes: [e_stop_service stall]
///   first_cause: e_stop_service
///   since: 2026-11-21T08:55:16Z
///   checksum: 91d2f3a8c0b7e645        of the three lines above (signals/checksum.h)
///
/// An absent file is no latch. Everything else that is not exactly such a record counts as a latch with the cause
/// kCauseLatchUnreadable: another format, an unknown cause, a wrong checksum, a file larger than kLargest, no regular
/// file, a link to nothing, no permission. After a release the file says `causes: []`.
///
/// Written by an ordinary thread as files/output_file.h says: whole or not at all, synchronised, through a symbolic
/// link. Missing folders are made. What is no regular file is never written to. A failure is kept in `problem` and
/// tried again whenever the causes change, and once a second.

#include <cstdint>
#include <future>
#include <string>

namespace robot_control {

struct LatchRecord {
  std::uint64_t causes = 0;  ///< StopCause bits
  std::uint64_t first_cause = 0;
  std::string since;  ///< UTC, when the first cause was recorded; empty: not latched, or not known

  bool same_stop(const LatchRecord& other) const noexcept {
    return causes == other.causes && first_cause == other.first_cause;
  }
};

std::string latch_text(const LatchRecord& record);

/// The record that `text` holds, or one with kCauseLatchUnreadable.
LatchRecord parse_latch(const std::string& text);

class LatchFile {
 public:
  static constexpr std::size_t kLargest = 4096;  ///< bytes; a record with every cause has about 700

  /// `path` empty: nothing is read or written.
  explicit LatchFile(const std::string& path);
  ~LatchFile() { wait(); }
  LatchFile(const LatchFile&) = delete;
  LatchFile& operator=(const LatchFile&) = delete;

  /// What the file held when this object was made.
  const LatchRecord& found() const noexcept { return found_; }

  /// Ordinary thread: begins to write when the causes differ from those of the file. Does not wait for the disk.
  void look(std::uint64_t causes, std::uint64_t first_cause);

  /// At the end: the same, and waits.
  void finish(std::uint64_t causes, std::uint64_t first_cause);

  /// Why the last record could not be written; empty: it was.
  const std::string& problem() const noexcept { return problem_; }

 private:
  void wait();
  void write(const LatchRecord& record);

  std::string path_;
  LatchRecord found_;
  LatchRecord written_;   ///< or about to be
  bool outdated_ = true;  ///< `written_` is not what the file holds
  std::int64_t next_try_ns_ = 0;
  std::string problem_;
  std::future<std::string> writing_;
};

/// Where the record lies: `setting` itself, or where that is a folder (ends with '/', or exists as one) the file
/// latch.<host>.<name space, '/' as '.'> in it.
std::string latch_path(const std::string& setting, const std::string& host, const std::string& name_space);

}  // namespace robot_control
