#pragma once
/// The file that keeps a latched stop over a reboot: parameter `latch_file` of the monitor.
///
///   causes: [e_stop_service stall]
///   first_cause: e_stop_service
///   since: 2026-11-21T08:55:16Z
///   checksum: 91d2f3a8c0b7e645        of the three lines above (signals/checksum.h)
///
/// An absent file is no latch. Anything else that is not such a record is a latch with kCauseLatchUnreadable. Examples
/// are another format, an unknown cause, a wrong checksum and a file larger than kMaxSize. So are a file that is not
/// regular, a link to nothing and a file without permission. After a release the file says `causes: []`.
///
/// An ordinary thread writes it as files/output_file.h says: whole or not at all, synchronised, through a symbolic
/// link. Missing folders are made. Only a regular file is written to. A failure is kept in `problem` and tried again
/// whenever the causes change, and once a second.

#include <cstdint>
#include <future>
#include <string>

#include "machine/machine_model.h"

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
  static constexpr std::size_t kMaxSize = 4096;  ///< bytes; a record with every cause has about 700

  /// `path` empty: nothing is read or written.
  explicit LatchFile(const std::string& path);
  ~LatchFile() { wait(); }
  LatchFile(const LatchFile&) = delete;
  LatchFile& operator=(const LatchFile&) = delete;

  /// The content of the file when this object was made.
  const LatchRecord& found() const noexcept { return found_; }

  /// Ordinary thread: begins to write when the causes differ from those of the file. Does not wait for the disk.
  void update(std::uint64_t causes, std::uint64_t first_cause);

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

/// Returns what distinguishes one robot from another as the owner of a latched stop: its name and those of the joints
/// that it drives. A change of its sizes, masses or parameters does not change it.
std::uint64_t stop_owner(const MachineModel& machine);

/// The path of the record: `setting` itself, unless it is a folder (it ends with '/', or exists as one). In a folder
/// each robot has a file of its own (stop_owner): latch.<host>.<name space, '/' as '.'>.<name of the robot>.<identity>.
/// A file of an older version, without name and identity, becomes that of the first robot that starts.
std::string latch_path(const std::string& setting, const std::string& host, const std::string& name_space,
                       const MachineModel& robot);

}  // namespace robot_control
