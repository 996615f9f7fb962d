#pragma once
/// A chunk of a bag holds connection and message records, one after the other, uncompressed or compressed as one
/// stream.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "log/bag/bag_file.h"
#include "log/bag/bag_record.h"

namespace robot_control {

/// An inflated chunk has at most this many bytes. rosbag record writes chunks of 768 kB unless --chunksize sets another
/// size.
inline constexpr std::uint32_t kMaxChunk = 256U << 20U;

enum class BagCompression : std::uint8_t { kNone, kBz2, kLz4 };

/// Location of a chunk in the file, and the properties that its header states.
struct BagChunkData {
  std::uint64_t record = 0;  ///< offset in the file of the chunk's record
  std::uint64_t begin = 0;   ///< offset in the file of its data
  std::uint32_t packed = 0;  ///< bytes of data in the file
  std::uint32_t size = 0;    ///< bytes of the inflated data
  BagCompression compression = BagCompression::kNone;

  /// Returns the place of the byte at `offset` in the content.
  BagPlace place(std::uint64_t offset) const;
};

/// Reads the content of the chunk into `content`. It never inflates more than `size` bytes. Throws BagError if the
/// compression is broken or the content does not have `size` bytes.
void read_bag_chunk(BagFile& file, const BagChunkData& chunk, std::string& content);

struct BagMessage {
  std::uint32_t connection = 0;  ///< its number in the bag
  std::uint32_t offset = 0;      ///< offset of its record in the content of the chunk, bytes
  std::uint64_t time_ns = 0;     ///< time of reception
  std::string_view data;         ///< serialized
};

/// The functions that receive the records of a chunk.
struct BagChunkUse {
  std::function<void(const BagRecord&)> connection;
  std::function<void(const BagMessage&)> message;
};

/// Passes each record of the content from byte `at` on to `use`; then `at` is the end of the content. Throws BagError
/// for the first record that is broken or of another kind; then `at` is its first byte.
void parse_bag_chunk(std::string_view content, const BagChunkData& chunk, const BagChunkUse& use, std::size_t& at);

}  // namespace robot_control
