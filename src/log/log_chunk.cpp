#include "log/log_chunk.h"

#include <algorithm>

#include "log/messages/trace_message.h"

namespace robot_control {
namespace {

constexpr std::uint32_t kHeader = 0;  // these are the numbers of the connections
constexpr std::uint32_t kTrace = 1;
constexpr std::uint32_t kSnapshot = 2;
constexpr std::uint32_t kSummary = 3;

}  // namespace

const std::vector<WrittenConnection>& log_connections() {
  static const std::vector<WrittenConnection> all{
      {.topic = "trace_header", .type = trace_header_type(), .latching = true},
      {.topic = "trace", .type = trace_type()},
      {.topic = "trace_snapshot", .type = snapshot_type()},
      {.topic = "trace_summary", .type = trace_summary_type()}};
  return all;
}

PackedChunk first_chunk(const LogHeader& header, std::int64_t time_ns) {
  ChunkBuilder first;
  first.add_record(connection_records(log_connections()));
  first.add(kHeader, time_ns, encode(header));
  return first.pack(Effort::kThorough);
}

std::int64_t stamp_of(const JoinedRow& row) noexcept {
  if (row.driver != nullptr) return due_ns(row.driver->sensors);
  if (row.estimator != nullptr) return row.estimator->state.head.stamp_ns;
  if (row.controller != nullptr) return row.controller->command.head.stamp_ns;
  return row.monitor != nullptr ? row.monitor->permit.head.stamp_ns : 0;
}

/// Times in a bag rise strictly and are above 0.
std::int64_t LogChunk::ros_time(std::int64_t stamp_ns) noexcept {
  last_ns_ = std::max(last_ns_ + 1, stamp_ns + offset_ns_);
  return last_ns_;
}

std::int64_t LogChunk::add(const JoinedRow& row, std::uint64_t lost, std::size_t joints) {
  const std::int64_t time_ns = ros_time(stamp_of(row));
  encode_trace({.row = row, .lost = lost, .joints = joints, .time_ns = time_ns}, message_);
  chunk_.add(kTrace, time_ns, message_);
  return time_ns;
}

void LogChunk::add(const LawSnapshot& snapshot) {
  LawSnapshot sealed = snapshot;
  seal(sealed);
  chunk_.add(kSnapshot, ros_time(sealed.head.stamp_ns), encode(sealed));
}

void LogChunk::add(const TraceSummary& summary) {
  if (last_ns_ == 0) return;
  // A later time would push the times of the rows that are still to come.
  chunk_.add(kSummary, last_ns_, encode(summary));
}

}  // namespace robot_control
