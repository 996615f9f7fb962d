#pragma once
/// ROS bags of version 2.0, checked from the first byte to the last before any of it is given away.
///
/// The file comes from outside. Records, header fields, chunk sizes, compression, the index of each chunk, connection
/// records and the chunk list at the end are compared with each other; the first contradiction refuses the whole bag
/// with byte and field. Memory is bounded by kMaxChunk (twice, and 24 bytes per message of it) and
/// kMaxConnections' text, whatever the file says; time by the size of the file and kInflatesTo. What passes is also
/// safe for librosbag, whose own parser reads out of bounds. What no format shows stays: of the messages' data only
/// compressed chunks have a checksum.
///
/// One kind of damage is no reason to refuse: a bag without a valid end, because its recorder was killed, the disk was
/// full or a copy was interrupted: `index_pos` is 0 or behind the end of the file, or the file ends in the list behind
/// the chunks. Then everything before the first
/// byte that is not sound is read, the messages of an unfinished uncompressed chunk included, and `cut` says which
/// part.
///
/// To inflate the chunks is half of the work. A caller that can drop what it got may therefore read each chunk while
/// the file is checked (`Early`), and none twice.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bags/bag_index.h"

namespace robot_control {

inline constexpr std::uint64_t kInflatesTo = 100;  ///< times the file; telemetry in bz2: 5 to 20
inline constexpr std::uint64_t kInflatesAnyhow = std::uint64_t{64} << 20U;  ///< bytes that a small bag may have besides
inline constexpr std::size_t kMaxConnections = 10'000;
inline constexpr std::size_t kMaxConnectionBytes = std::size_t{64} << 20U;  ///< bytes of all their records together
inline constexpr std::size_t kMaxChunks = std::size_t{1} << 20U;

struct BagConnection {
  std::string topic, type, md5sum, definition;

  bool operator==(const BagConnection&) const = default;
};

class BagReader {
 public:
  /// Gets each chunk as soon as it is sound by itself, and the reader, whose `connections` and `read` may be used. The
  /// rest of the file may still refuse the bag: where the constructor throws, the caller drops what it got.
  using Early = std::function<void(BagReader& bag, const BagChunk& chunk)>;

  /// Reads and checks the whole file. Throws BagError: it is no sound bag; std::runtime_error: no file to read.
  explicit BagReader(const std::string& path, Early early = {});

  /// By the number that messages have in `BagMessage::connection`.
  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  const std::vector<BagChunk>& chunks() const { return chunks_; }
  std::uint64_t messages() const { return messages_; }

  /// Which part of the file is read, and why not all of it; empty: it is whole.
  const std::string& cut() const { return cut_; }

  /// Of the file, in bytes.
  std::uint64_t size() const { return file_.size(); }

  /// The messages of one of the chunks, in the order of the file; their data are valid within the call. Throws
  /// BagError: the file has changed.
  void read(const BagChunk& chunk, const std::function<void(const BagMessage&)>& use);

 private:
  struct End;  // what the bag header announces of the end of the file

  End read_bag_header();
  void read_records(const End& end);
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
  std::map<std::uint32_t, BagConnection> connections_;
  std::size_t connection_bytes_ = 0;
  std::vector<BagChunk> chunks_;
  std::uint64_t messages_ = 0;
  std::uint64_t inflated_ = 0;  // bytes of all compressed chunks
  std::string cut_;
  bool behind_ = false;  // the chunks

  // The chunk that was parsed last, until its index is compared.
  bool pending_ = false;
  BagChunkIndex index_;
  std::optional<std::uint64_t> inflated_record_;  // of the chunk that is in `content_`
  std::string content_;
};

}  // namespace robot_control
