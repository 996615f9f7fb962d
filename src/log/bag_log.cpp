#include "log/bag_log.h"

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "log/log_error.h"

namespace robot_control {

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
  writer_ = std::make_unique<BagWriter>(path, log_connections(),
                                        [this](std::int64_t bytes) { return folder_.make_room(bytes); });
}

/// The header has the time of the first chunk, so that a player does not wait for it.
void BagLog::write_header(std::int64_t time_ns) {
  writer_->write(first_chunk(header_, time_ns));
  bag_begin_ns_ = time_ns;
  ++header_.part;
}

void BagLog::write(const JoinedRow& row) {
  const bool moves = motion_.step(row, stamp_of(row));
  recording_ =
      requested_ || parameters_.record == RecordMode::kAlways || (parameters_.record == RecordMode::kMotion && moves);
  const std::int64_t time_ns = chunk_.add(row, lost_before_ + unwritten_, header_.joints.size());
  ++chunk_rows_;
  chunk_wanted_ = chunk_wanted_ || recording_;
  const auto next_ns = time_ns + std::llround(header_.period * 1e9);
  if (next_ns - chunk_.begin_ns() >= kChunkNs || chunk_.size() >= kChunkBytes) end_chunk();
}

void BagLog::write(const LawSnapshot& snapshot) {
  chunk_.add(snapshot);
  chunk_snapshot_ = true;
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
  held_.push_back({.chunk = chunk_.pack(Effort::kThorough),
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

namespace {

bool moves(const JoinedRow& row) noexcept {
  if (row.driver == nullptr || row.estimator == nullptr || row.controller == nullptr || row.monitor == nullptr) {
    return true;
  }
  return (row.estimator->state.base.flags & kStateStandstill) == 0 || !zero(row.controller->command.requested.twist);
}

}  // namespace

bool MotionWatch::step(const JoinedRow& row, std::int64_t time_ns) noexcept {
  bool event = moves(row);
  if (row.monitor != nullptr) {
    const auto state = static_cast<std::uint64_t>(row.monitor->permit.state);
    event = event || state != state_ || row.monitor->permit.causes != causes_;
    state_ = state;
    causes_ = row.monitor->permit.causes;
  }
  if (event) until_ns_ = time_ns + kTimeAfterStop;
  return time_ns < until_ns_;
}

}  // namespace robot_control
