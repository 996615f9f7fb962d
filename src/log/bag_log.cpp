#include "log/bag_log.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "log/log_error.h"
#include "log/messages/trace_message.h"

namespace robot_control {
namespace {

constexpr std::uint32_t kHeader = 0;  // these are the numbers of the connections
constexpr std::uint32_t kTrace = 1;
constexpr std::uint32_t kSnapshot = 2;
constexpr std::uint32_t kSummary = 3;

std::vector<WrittenConnection> connections() {
  return {{.topic = "trace_header", .type = trace_header_type(), .latching = true},
          {.topic = "trace", .type = trace_type()},
          {.topic = "trace_snapshot", .type = snapshot_type()},
          {.topic = "trace_summary", .type = trace_summary_type()}};
}

std::int64_t stamp_of(const JoinedRow& row) {
  if (row.driver != nullptr) return due_ns(row.driver->sensors);
  if (row.estimator != nullptr) return row.estimator->state.head.stamp_ns;
  if (row.controller != nullptr) return row.controller->command.head.stamp_ns;
  return row.monitor != nullptr ? row.monitor->permit.head.stamp_ns : 0;
}

}  // namespace

BagLog::BagLog(LogFolder& folder, LogHeader header, const TelemetryParameters& parameters)
    : folder_(folder), header_(std::move(header)), parameters_(parameters) {
  begin_bag();
}

void BagLog::set_header(LogHeader header) {
  header.part = header_.part;
  header_ = std::move(header);
}

void BagLog::begin_bag() {
  const std::string path = folder_.begin();
  bag_begin_ns_ = 0;
  split_due_ns_ = 0;
  writer_ =
      std::make_unique<BagWriter>(path, connections(), [this](std::int64_t bytes) { return folder_.make_room(bytes); });
}

/// The header has the time of the first chunk, so that a player does not wait for it.
void BagLog::write_header(std::int64_t time_ns) {
  ChunkBuilder first;
  first.add_record(writer_->connection_records());
  first.add(kHeader, time_ns, encode(header_));
  writer_->write(first.pack());
  bag_begin_ns_ = time_ns;
  ++header_.part;
}

/// Times in a bag rise strictly and are above 0.
std::int64_t BagLog::ros_time(std::int64_t stamp_ns) noexcept {
  last_ns_ = std::max(last_ns_ + 1, stamp_ns + offset_ns_);
  return last_ns_;
}

void BagLog::write(const JoinedRow& row) {
  const std::int64_t stamp_ns = stamp_of(row);
  const std::int64_t time_ns = ros_time(stamp_ns);
  const bool moves = motion_.step(row, stamp_ns);
  recording_ =
      requested_ || parameters_.record == RecordMode::kAlways || (parameters_.record == RecordMode::kMotion && moves);
  encode_trace({.row = row, .lost = lost_before_ + unwritten_, .joints = header_.joints.size(), .time_ns = time_ns},
               message_);
  chunk_.add(kTrace, time_ns, message_);
  ++chunk_rows_;
  chunk_wanted_ = chunk_wanted_ || recording_;
  const auto next_ns = time_ns + std::llround(header_.period * 1e9);
  if (next_ns - chunk_.begin_ns() >= kChunkNs || chunk_.size() >= kChunkBytes) end_chunk();
}

void BagLog::write(const LawSnapshot& snapshot) {
  LawSnapshot sealed = snapshot;
  seal(sealed);
  chunk_.add(kSnapshot, ros_time(sealed.head.stamp_ns), encode(sealed));
  chunk_snapshot_ = true;
}

void BagLog::write(const TraceSummary& summary) {
  if (last_ns_ == 0) return;  // there is no row yet
  // A later time would push the times of the rows that are still to come.
  chunk_.add(kSummary, last_ns_, encode(summary));
}

void BagLog::write_last(const TraceSummary& summary) {
  end_chunk();
  held_.clear();
  if (bag_begin_ns_ == 0) return;
  write(summary);
  chunk_wanted_ = true;
}

void BagLog::end_chunk() {
  if (chunk_.empty()) return;
  const std::int64_t begin_ns = chunk_.begin_ns();
  held_.push_back({.chunk = chunk_.pack(),
                   .begin_ns = begin_ns,
                   .rows = std::exchange(chunk_rows_, 0),
                   .snapshot = std::exchange(chunk_snapshot_, false)});
  flush_ns_ = 0;
  if (std::exchange(chunk_wanted_, false)) {
    write_held();
    return;
  }
  held_bytes_ += held_.back().chunk.record.size();
  while (held_.size() > 1 &&
         (held_bytes_ > kBeforeBytes || begin_ns - held_.front().begin_ns > before_ns(header_.period))) {
    held_bytes_ -= held_.front().chunk.record.size();
    held_.pop_front();
  }
}

void BagLog::write_held() {
  held_bytes_ = 0;
  std::optional<LogError> problem;
  for (const std::deque<Held> held = std::exchange(held_, {}); const Held& each : held) {
    try {
      hand_over(each);  // each chunk is counted where it fails
    } catch (const LogError& error) {
      problem = error;
    }
  }
  if (problem) throw LogError(*problem);
}

void BagLog::hand_over(const Held& held) {
  if (writer_ == nullptr) {
    unwritten_ += held.rows;
    return;
  }
  try {
    split_where_due(held);
    if (bag_begin_ns_ == 0) write_header(held.begin_ns);
    writer_->write(held.chunk);
  } catch (const LogError&) {
    unwritten_ += held.rows;
    writer_ = nullptr;
    throw;
  }
  rows_ += held.rows;
}

void BagLog::split_where_due(const Held& next) {
  const double seconds = static_cast<double>(next.begin_ns - bag_begin_ns_) * 1e-9;
  const auto reached = [&](double gigabytes) {
    return gigabytes > 0 && static_cast<double>(writer_->bytes()) >= gigabytes * 1e9;
  };
  // Only closed bags can be removed, so a bag has at most a quarter of the quota.
  const bool too_large = reached(parameters_.quota / 4);
  const bool long_enough = parameters_.split_time > 0 && bag_begin_ns_ != 0 && seconds >= parameters_.split_time;
  if (!too_large && !reached(parameters_.split_size) && !long_enough) return;
  if (split_due_ns_ == 0) split_due_ns_ = next.begin_ns;
  if (!too_large && !next.snapshot && next.begin_ns - split_due_ns_ < before_ns(header_.period)) return;
  writer_->close();
  begin_bag();
}

void BagLog::poll(std::int64_t now_ns) {
  if (writer_ == nullptr) {
    if (retry_ns_ == 0) retry_ns_ = now_ns + kRetryNs;
    if (now_ns < retry_ns_) return;
    retry_ns_ = now_ns + kRetryNs;
    begin_bag();
    retry_ns_ = 0;
    return;
  }
  if (!chunk_.empty() && flush_ns_ == 0) flush_ns_ = now_ns + 2 * kChunkNs;
  if (flush_ns_ != 0 && now_ns >= flush_ns_) end_chunk();
}

void BagLog::close() {
  end_chunk();
  if (writer_ == nullptr) return;
  writer_->close();
  std::error_code ignored;
  if (bag_begin_ns_ != 0) return;
  const std::string path = folder_.path();  // the bag holds no message
  if (std::filesystem::is_regular_file(std::filesystem::symlink_status(path, ignored))) {
    std::filesystem::remove(path, ignored);
  }
}

}  // namespace robot_control
