#pragma once
/// This writer appends a ROS bag chunk by chunk.
///
/// The library rosbag_storage is not used: it ends the process if the disk is full while a bag is closed. It also
/// cannot keep a chunk back. Every reader of the format reads these bags, also rosbag (tested). `close` writes the
/// index. After a kill there is none, and rosbag needs `rosbag reindex`; log/bag/bag_reader.h needs no index.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "files/descriptor.h"
#include "log/messages/message_types.h"
#include "log/packed_chunk.h"

namespace robot_control {

/// A file of a log grows by whole parts and ends with its last whole part, whatever the disk does.
///
/// Without room, on a full disk or after another error, the file ends, and LogError says why, once: `open` is false
/// then, and the owner writes no more. Bytes written to a removed file are lost without an error; `check_presence`
/// notices it.
class LogFile {
 public:
  /// True: the file may grow to so many bytes. An empty function sets no limit.
  using Room = std::function<bool(std::int64_t)>;

  /// Makes the folders above `path` and replaces the file. Throws LogError.
  LogFile(std::string path, Room room);

  /// Throws LogError where the file is not at its path any more.
  void check_presence();

  /// Appends one part. Throws LogError.
  void append(std::string_view part);

  /// Replaces the file's first bytes. Throws LogError.
  void replace_begin(std::string_view bytes);

  /// Synchronises and closes the file. Throws LogError. Without this call it is closed at last, and errors are ignored.
  void close();

  bool open() const noexcept { return file_.open(); }
  std::int64_t bytes() const noexcept { return bytes_; }  ///< size up to the end of the last whole part
  const std::string& path() const noexcept { return path_; }

 private:
  [[noreturn]] void fail(const std::string& why, int error);

  std::string path_;
  Room room_;
  Descriptor file_;
  std::int64_t bytes_ = 0;
};

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
