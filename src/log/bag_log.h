#pragma once
/// The log of every cycle is a ROS bag, run.bag, with the topics `trace_header` (latched, first), `trace`,
/// `trace_snapshot` and, on the wall clock, `trace_summary`.
///
/// Rows are collected in chunks of a second. If only motion is recorded (MotionWatch), the chunks of the last
/// `before_ns` are held in memory and written when motion begins. A bag of the permitted size or length is closed and
/// kept under the next number, and another one begins (log_folder.h). It begins with the next snapshots of the laws, so
/// that it can be replayed from its begin. If none comes within `before_ns`, or the quota is small, it begins without.
///
/// A bag without a message is removed at the end.
///
/// An error of the disk ends the bag, not the log: rows are counted, and another bag is tried every `kRetryNs`. All
/// times are arguments; no clock is read.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>

#include "log/bag_writer.h"
#include "log/log_chunk.h"
#include "log/log_folder.h"
#include "log/log_parameters.h"
#include "log/messages/log_messages.h"
#include "log/rows/joined_row.h"
#include "log/rows/row_log.h"
#include "signals/law_snapshot.h"

namespace robot_control {

/// If only motion is recorded (telemetry.record: motion), this watch decides which cycles are.
///
/// The robot moves while a velocity other than zero is requested, while the estimator reports no standstill, or while a
/// node gives no frame. A change of the safety monitor's state or causes counts as motion. Motion ends `kTimeAfterStop`
/// later.
class MotionWatch {
 public:
  static constexpr std::int64_t kTimeAfterStop = 5'000'000'000;  ///< ns; the oscillation after a stop is recorded, too

  /// True: the cycle is to be recorded.
  bool step(const JoinedRow& row, std::int64_t time_ns) noexcept;

 private:
  std::uint64_t state_ = 0;
  std::uint64_t causes_ = 0;
  std::int64_t until_ns_ = 0;
};

class BagLog final : public RowLog {
 public:
  static constexpr std::int64_t kChunkNs = 1'000'000'000;
  static constexpr std::size_t kChunkBytes = 1 << 22;        ///< uncompressed size at which a chunk ends early
  static constexpr std::int64_t kBeforeNs = 12'000'000'000;  ///< of a loop of 93 Hz and more
  static constexpr std::size_t kBeforeBytes = 32 << 20;  ///< compressed; at 2 kHz with 32 joints it is less than 12 s
  static constexpr std::int64_t kRetryNs = 10'000'000'000;

  /// Returns for how long rows are held, ns: kBeforeNs, and at least from one snapshot to the next; `period` in s.
  static std::int64_t before_ns(double period) noexcept {
    return std::max<std::int64_t>(kBeforeNs, kChunkNs + std::llround(1e9 * period * kSnapshotCycles));
  }

  /// Begins run.bag in `folder`, which must outlive this object. The quota is that of the folder. Throws LogError.
  BagLog(LogFolder& folder, LogHeader header, const TelemetryParameters& parameters);

  /// As LogChunk::set_time_offset.
  void set_time_offset(std::int64_t offset_ns) noexcept { chunk_.set_time_offset(offset_ns); }

  /// Sets the header of the bags that begin from now on. Joints and period must stay the same.
  void set_header(LogHeader header);

  /// `rows` were lost since the beginning before they reached this log.
  void set_lost(std::uint64_t rows) noexcept { lost_before_ = rows; }

  /// Every cycle is recorded while `on` is true.
  void request(bool on) noexcept { requested_ = on; }

  void write(const JoinedRow& row) override;

  /// A snapshot comes before the row to which it belongs.
  void write(const LawSnapshot& snapshot) override;

  /// Writes the figures of the timing beside the rows.
  void write(const TraceSummary& summary) { chunk_.add(summary); }

  /// Writes the figures of the whole log, after its last row; `close` follows. Without a row in the bag it does
  /// nothing.
  void write_last(const TraceSummary& summary);

  /// The caller calls this at 10 Hz; `now_ns` is on any clock that runs. A chunk of a second goes to the disk, also if
  /// no row follows. After an error another bag is tried. Throws LogError.
  void poll(std::int64_t now_ns);

  void close() override;

  bool recording() const noexcept { return recording_; }
  std::uint64_t rows() const noexcept { return rows_; }            ///< number that the disk has taken
  std::uint64_t unwritten() const noexcept { return unwritten_; }  ///< number that the disk has refused
  bool broken() const noexcept { return writer_ == nullptr; }      ///< no bag is open since the last error

 private:
  struct Held {
    PackedChunk chunk;
    std::int64_t begin_ns = 0;  ///< ROS time
    std::uint64_t rows = 0;
    bool snapshot = false;  ///< true: it holds a snapshot
  };

  void begin_bag();
  void write_header(std::int64_t time_ns);
  void end_chunk();
  void write_held();
  void hand_over(const Held& held);
  void split_where_due(const Held& next);

  LogFolder& folder_;
  LogHeader header_;
  TelemetryParameters parameters_;
  std::unique_ptr<BagWriter> writer_;
  std::int64_t bag_begin_ns_ = 0;  ///< ROS time of the bag's first chunk; 0: it has none yet
  LogChunk chunk_;
  std::uint64_t chunk_rows_ = 0;
  bool chunk_wanted_ = false;      ///< true: the open chunk is to be recorded
  bool chunk_snapshot_ = false;    ///< true: the open chunk holds a snapshot
  std::int64_t split_due_ns_ = 0;  ///< ROS time since which a new bag is due; 0: none is
  std::deque<Held> held_;
  std::size_t held_bytes_ = 0;
  MotionWatch motion_;
  bool requested_ = false;
  bool recording_ = false;
  std::int64_t flush_ns_ = 0;  ///< value of `now_ns` at which the open chunk is due
  std::int64_t retry_ns_ = 0;
  std::uint64_t lost_before_ = 0;
  std::uint64_t rows_ = 0;
  std::uint64_t unwritten_ = 0;
};

}  // namespace robot_control
