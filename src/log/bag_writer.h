#pragma once
/// This writer appends a ROS bag chunk by chunk.
///
/// The library rosbag_storage is not used: it ends the process if the disk is full while a bag is closed. It also
/// cannot keep a chunk back. Every reader of the format reads these bags, also rosbag (tested). `close` writes the
/// index. After a kill there is none, and rosbag needs `rosbag reindex`; log/bag/bag_reader.h needs no index.

#include <cstdint>
#include <string>
#include <vector>

#include "log/log_file.h"
#include "log/messages/message_types.h"
#include "log/packed_chunk.h"

namespace robot_control {

struct WrittenConnection {
  std::string topic;
  MessageType type;
  bool latching = false;
};

/// The first record of a bag; 0: it has no index.
std::string bag_opening(std::uint64_t index_position, std::size_t connections, std::uint32_t chunks);

/// The first chunk begins with these records of the connections, which are numbered 0, 1, …
std::string connection_records(const std::vector<WrittenConnection>& connections);

class BagWriter {
 public:
  /// Makes the folders above `path` and replaces the file. Throws LogError.
  BagWriter(std::string path, std::vector<WrittenConnection> connections, LogFile::Room room);

  /// Closes the bag and ignores errors; `close` reports them.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Throws LogError if the disk refuses the chunk, or the file is not at its path any more. The bag then ends with its
  /// last whole chunk, and further chunks are ignored.
  void write(const PackedChunk& chunk);

  /// Writes the index. Throws LogError.
  void close();

  bool open() const noexcept { return file_.open(); }
  std::int64_t bytes() const noexcept { return file_.bytes(); }  ///< size up to the end of the last whole chunk
  const std::string& path() const noexcept { return file_.path(); }

 private:
  LogFile file_;
  std::vector<WrittenConnection> connections_;
  std::uint32_t chunks_ = 0;
  std::string chunk_infos_;  ///< records of the final index
};

}  // namespace robot_control
