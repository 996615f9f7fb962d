#pragma once
/// A BagReader reads the ROS bags of bag_writer.h and checks the whole file before it returns any of it. Bags of other
/// programs, which have other compressions, are read by the ROS library (python/robot_control/files/bag_file.py).
///
/// The file may come from anywhere. Records, header fields, chunk sizes, compression, connection records and the chunk
/// list at the end are compared with each other. Times rise from chunk to chunk. The first contradiction refuses the
/// whole bag with byte and field. The index behind each chunk but the last is compared by presence and first time only.
/// Memory is bounded by kMaxChunk (twice), kMaxConnections and the size of the file, time by that size, because LZ4
/// inflates to 255 times at most.
///
/// A bag without a valid end is accepted, because its writer may have been killed, the disk full or a copy interrupted.
/// Then `index_pos` is 0 or behind the end of the file, or the file ends in the list behind the chunks. Everything
/// before the first broken byte is read, and `cut` names this part.
///
/// Half of the work is to inflate the chunks. A caller that can discard data may therefore read each chunk while the
/// file is checked (`Early`), so that no chunk is inflated twice.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "log/bag/bag_chunk.h"

namespace robot_control {

inline constexpr std::size_t kMaxConnections = 16;  ///< a log has four
inline constexpr std::size_t kMaxChunks = std::size_t{1} << 20U;

struct BagConnection {
  std::string topic, type, md5sum, definition;

  bool operator==(const BagConnection&) const = default;
};

class BagReader {
 public:
  /// Is called for each chunk that is correct by itself, with the reader, whose `connections` and `read` may be used. A
  /// later part of the file may still refuse the bag. If the constructor throws, the caller discards the chunks.
  using Early = std::function<void(BagReader& bag, const BagChunk& chunk)>;

  /// Is called where a part of the bag is broken. Reading goes on with the next chunk.
  using Damaged = std::function<void()>;

  /// Reads and checks the whole file. Throws BagError if the bag is broken, unless `damaged` is given and its begin is
  /// sound; std::runtime_error if the file cannot be read.
  explicit BagReader(const std::string& path, Early early = {}, Damaged damaged = {});

  /// Returns the connections by their number (`BagMessage::connection`).
  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  const std::vector<BagChunk>& chunks() const { return chunks_; }
  std::uint64_t messages() const { return messages_; }

  /// Says which part of the file is read and why the rest is not; "" if all is read.
  const std::string& cut() const { return cut_; }

  /// Returns the size of the file in bytes.
  std::uint64_t size() const { return file_.size(); }

  /// Passes the messages of a chunk to `use` in the order of the file; their data are valid during the call. Throws
  /// BagError if the file has changed.
  void read(const BagChunk& chunk, const std::function<void(const BagMessage&)>& use);

 private:
  struct End;  // the properties of the file's end that the bag header announces

  End read_bag_header();
  void read_records(const End& end);
  std::uint64_t read_record(const End& end, std::uint64_t at);
  std::uint64_t next_chunk(std::uint64_t at);
  void read_chunk(BagChunk chunk, const BagHeader& header);
  void check_index(std::string_view data, const BagPlace& place);
  [[noreturn]] void refuse_index(const BagPlace& place, const char* field, const char* problem);
  void commit();
  void add_connection(const BagHeader& header, std::string_view data, const BagPlace& place);
  void check_chunk_info(const BagHeader& header) const;
  void describe_cut(const BagError& error, std::uint64_t index);
  void inflate(const BagChunk& chunk);

  BagFile file_;
  Early early_;
  Damaged damaged_;
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<BagChunk> chunks_;
  std::optional<BagChunk> pending_;  // the last chunk, until its index is compared
  bool indexed_ = false;             // an index stands behind it
  std::uint64_t messages_ = 0;
  std::string cut_;
  bool behind_ = false;                           // the reader has passed the last chunk
  std::size_t defined_ = 0, listed_ = 0;          // records behind the chunks
  std::optional<std::uint64_t> inflated_record_;  // record of the chunk whose content is in `content_`
  std::string content_;
};

}  // namespace robot_control
