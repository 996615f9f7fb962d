#pragma once
/// What a chunk holds: connection and message records, one after the other, as they are or compressed as one stream.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bags/bag_file.h"
#include "bags/bag_record.h"

namespace robot_control {

/// Bytes of one inflated chunk; rosbag record makes them of 768 kB unless --chunksize says otherwise.
inline constexpr std::uint32_t kMaxChunk = 256U << 20U;

enum class BagCompression : std::uint8_t { kNone, kBz2, kLz4 };

/// Where a chunk is and what its header says of it.
struct BagChunkData {
  std::uint64_t record = 0;  ///< offset in the file of the chunk's record
  std::uint64_t begin = 0;   ///< offset in the file of its data
  std::uint32_t packed = 0;  ///< bytes in the file
  std::uint32_t size = 0;    ///< bytes, inflated
  BagCompression compression = BagCompression::kNone;

  /// Of a byte of the content.
  BagPlace place(std::uint64_t offset) const;
};

/// The content, in `content`. Never more than `size` bytes are inflated. Throws BagError: broken compression, or
/// another number of bytes than `size`.
void read_bag_chunk(BagFile& file, const BagChunkData& chunk, std::string& content);

struct BagMessage {
  std::uint32_t connection = 0;  ///< its number in the bag
  std::uint32_t offset = 0;      ///< of its record in the content of the chunk, bytes
  std::uint64_t time_ns = 0;     ///< of its reception
  std::string_view data;         ///< serialized
};

/// The functions that receive the records of a chunk.
struct BagChunkUse {
  std::function<void(const BagRecord&)> connection;
  std::function<void(const BagMessage&)> message;
};

/// Gives each record of the content from byte `at` on to `use`; `at` is then the end of the content. Throws BagError
/// for the first record that is broken or of neither kind; `at` is then its first byte.
void parse_bag_chunk(std::string_view content, const BagChunkData& chunk, const BagChunkUse& use, std::size_t& at);

}  // namespace robot_control
