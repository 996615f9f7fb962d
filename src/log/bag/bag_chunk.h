#pragma once
/// A chunk of a bag holds connection and message records, one after the other, compressed with LZ4 as one stream, which
/// has a checksum.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "log/bag/bag_file.h"
#include "log/bag/bag_record.h"

namespace robot_control {

/// An inflated chunk has at most this many bytes.
inline constexpr std::uint32_t kMaxChunk = 256U << 20U;

/// Location of a chunk in the file, the properties that its header states, and a summary of its messages.
struct BagChunk {
  std::uint64_t record = 0;                 ///< offset in the file of the chunk's record
  std::uint64_t begin = 0;                  ///< offset in the file of its data
  std::uint32_t packed = 0;                 ///< bytes of data in the file
  std::uint32_t size = 0;                   ///< bytes of the inflated data
  std::uint64_t first_ns = 0, last_ns = 0;  ///< earliest and latest reception
  std::uint32_t messages = 0;
};

/// Reads the content of the chunk into `content`. It never inflates more than `size` bytes. Throws BagError if the
/// compression is broken or the content does not have `size` bytes.
void read_bag_chunk(BagFile& file, const BagChunk& chunk, std::string& content);

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

/// Passes each record of the content on to `use`. Throws BagError for the first record that is broken or of another
/// kind.
void parse_bag_chunk(std::string_view content, const BagChunk& chunk, const BagChunkUse& use);

}  // namespace robot_control
