#pragma once
/// Collects the messages of a log for a chunk of its bag.

#include <cstdint>
#include <string>
#include <vector>

#include "log/bag_writer.h"
#include "log/messages/log_messages.h"
#include "log/packed_chunk.h"
#include "log/rows/joined_row.h"

namespace robot_control {

/// The topics of a log.
const std::vector<WrittenConnection>& log_connections();

/// A bag of a log begins with this chunk, which holds the connections and the header.
PackedChunk first_chunk(const LogHeader& header, std::int64_t time_ns);

/// When the cycle was due, on the clock of its stamps, ns; 0: the row has no node.
std::int64_t stamp_of(const JoinedRow& row) noexcept;

class LogChunk {
 public:
  /// `offset_ns` is ROS time − stamps; it is 0 in lockstep, whose stamps are ROS time.
  void set_time_offset(std::int64_t offset_ns) noexcept { offset_ns_ = offset_ns; }

  /// Returns the ROS time of the message. `lost`: TraceSource::lost; `joints`: number of the robot's joints.
  std::int64_t add(const JoinedRow& row, std::uint64_t lost, std::size_t joints);
  void add(const LawSnapshot& snapshot);

  /// Nothing is added before the first row.
  void add(const TraceSummary& summary);

  bool empty() const noexcept { return chunk_.empty(); }
  std::size_t size() const noexcept { return chunk_.size(); }  ///< uncompressed bytes
  std::int64_t begin_ns() const noexcept { return chunk_.begin_ns(); }
  PackedChunk pack(Effort effort) { return chunk_.pack(effort); }

 private:
  std::int64_t ros_time(std::int64_t stamp_ns) noexcept;

  ChunkBuilder chunk_;
  std::string message_;
  std::int64_t offset_ns_ = 0;
  std::int64_t last_ns_ = 0;  ///< ROS time of the last message
};

}  // namespace robot_control
