#pragma once
/// A ROS bag, written chunk by chunk.
///
/// Of the library rosbag_storage nothing is used: it ends the process where the disk is full when a bag is closed, and
/// cannot keep a chunk back. What is written here is read by rosbag and by every other reader of the format (tested).
/// The file ends with an index; until `close` it has none, and rosbag needs `rosbag reindex` where the writer was
/// killed. bags/bag_reader.h needs no index.

#include <cstdint>
#include <string>
#include <vector>

#include "recording/message_types.h"
#include "recording/packed_chunk.h"
#include "telemetry/log_file.h"

namespace robot_control {

struct WrittenConnection {
  std::string topic;
  MessageType type;
  bool latching = false;
};

class BagWriter {
 public:
  /// Makes the folders above `path` and replaces the file. The connections are numbered 0, 1, … Throws LogError.
  BagWriter(std::string path, std::vector<WrittenConnection> connections, LogFile::Room room);

  /// Closes without a word; call `close` to learn of errors.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// The records of the connections: the first chunk begins with them.
  std::string connection_records() const;

  /// Throws LogError where the disk does not take it, or the file is not at its path any more; the bag then ends with
  /// its last whole chunk, and what follows is ignored.
  void write(const PackedChunk& chunk);

  /// Writes the index. Throws LogError.
  void close();

  bool open() const noexcept { return file_.open(); }
  std::int64_t bytes() const noexcept { return file_.bytes(); }  ///< up to the end of the last whole chunk
  const std::string& path() const noexcept { return file_.path(); }

 private:
  std::string opening(std::uint64_t index_position) const;

  LogFile file_;
  std::vector<WrittenConnection> connections_;
  std::uint32_t chunks_ = 0;
  std::string chunk_infos_;  ///< records of the final index
};

}  // namespace robot_control
