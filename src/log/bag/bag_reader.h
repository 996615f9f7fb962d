#pragma once
/// A BagReader reads ROS bags of version 2.0 and checks the whole file before it returns any of it.
///
/// The file may come from anywhere. Records, header fields, chunk sizes, compression, the index of each chunk,
/// connection records and the chunk list at the end are compared with each other. The first contradiction refuses the
/// whole bag with byte and field. Memory is bounded by kMaxChunk (twice, and 24 bytes per message of a chunk) and
/// kMaxConnectionBytes; time by the size of the file and kInflatesTo. An accepted bag is also safe for librosbag, whose
/// own parser reads out of bounds. Wrong data of messages are not found in uncompressed chunks, because only compressed
/// chunks have a checksum.
///
/// A bag without a valid end is accepted, because its recorder may have been killed, the disk full or a copy
/// interrupted. Then `index_pos` is 0 or behind the end of the file, or the file ends in the list behind the chunks.
/// Everything before the first broken byte is read, also the messages of an unfinished uncompressed chunk, and `cut`
/// names this part.
///
/// Half of the work is to inflate the chunks. A caller that can discard data may therefore read each chunk while the
/// file is checked (`Early`), so that no chunk is inflated twice.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "log/bag/bag_index.h"

namespace robot_control {

inline constexpr std::uint64_t kInflatesTo = 100;  ///< times the size of the file; telemetry in bz2 has 5 to 20
inline constexpr std::uint64_t kInflatesAnyhow = std::uint64_t{64}
                                                 << 20U;  ///< bytes added to this bound for small bags
inline constexpr std::size_t kMaxConnections = 10'000;
inline constexpr std::size_t kMaxConnectionBytes = std::size_t{64}
                                                   << 20U;  ///< bytes of all connection records together
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
  void read_chunk(std::uint64_t record, const BagHeader& header, std::uint64_t begin, std::uint32_t length);
  [[noreturn]] void read_unfinished(std::uint64_t record, const BagHeader& header, std::uint64_t begin);
  void add_connection(const BagHeader& header, std::string_view data, const BagPlace& place);
  void begin_list();
  void end_chunk();
  void commit();
  void parse(std::size_t& at, const BagChunkData& chunk);
  void check_chunk_info(std::size_t number, const BagHeader& header, std::string_view data,
                        const BagPlace& place) const;
  void describe_cut(const BagError& error, std::uint64_t index);

  void inflate(const BagChunkData& chunk);

  BagFile file_;
  Early early_;
  Damaged damaged_;
  std::map<std::uint32_t, BagConnection> connections_;
  std::size_t connection_bytes_ = 0;
  std::vector<BagChunk> chunks_;
  std::uint64_t messages_ = 0;
  std::uint64_t inflated_ = 0;  // bytes of all compressed chunks
  std::string cut_;
  bool behind_ = false;                   // the reader has passed the last chunk
  std::size_t defined_ = 0, listed_ = 0;  // records behind the chunks

  // These members describe the last parsed chunk until its index is compared.
  bool pending_ = false;
  BagChunkIndex index_;
  std::optional<std::uint64_t> inflated_record_;  // record of the chunk whose content is in `content_`
  std::string content_;
};

}  // namespace robot_control
