#pragma once
/// The index behind each chunk is compared with the messages in the chunk: each message needs one entry, each entry one
/// message.

#include <cstdint>
#include <string_view>
#include <vector>

#include "log/bag/bag_chunk.h"

namespace robot_control {

/// A chunk with a summary of its messages.
struct BagChunk {
  BagChunkData data;
  std::uint64_t first_ns = 0, last_ns = 0;  ///< earliest and latest reception
  std::uint32_t messages = 0;
  std::uint64_t connections = 0;  ///< bit n: the chunk has messages of a connection whose number is n modulo 64
  std::uint64_t counts = 0;       ///< digest of the pairs (connection, number of its messages)
};

/// Computes the digest in `BagChunk::counts`; the order of the pairs does not matter.
class BagCounts {
 public:
  void add(std::uint32_t connection, std::uint32_t count);
  std::uint64_t digest() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

/// Compares the messages of the last parsed chunk with its index.
class BagChunkIndex {
 public:
  void begin(const BagChunkData& chunk);
  void add(const BagMessage& message);
  /// Records that the chunk was not finished and ends after `size` bytes.
  void cut(std::uint32_t size) { chunk_.data.size = chunk_.data.packed = size; }
  const BagChunk& chunk();  ///< is called after the last message

  /// Compares the data of one index record. Throws BagError if they contradict the messages.
  void compare(std::uint32_t connection, std::uint32_t count, std::string_view data, const BagPlace& place);

  /// Is called after the last index record. Throws BagError if a message is in no index record.
  void finish() const;

 private:
  struct Entry {
    std::uint32_t offset, connection;
    std::uint64_t time_ns;
    bool indexed;
  };

  BagChunk chunk_;
  std::vector<Entry> entries_;
};

}  // namespace robot_control
