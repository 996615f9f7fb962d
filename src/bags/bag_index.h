#pragma once
/// The index behind each chunk, compared with the messages that the chunk really holds: an entry for every message, and
/// no entry without one.

#include <cstdint>
#include <string_view>
#include <vector>

#include "bags/bag_chunk.h"

namespace robot_control {

/// A chunk and what its messages are.
struct BagChunk {
  BagChunkData data;
  std::uint64_t first_ns = 0, last_ns = 0;  ///< earliest and latest reception
  std::uint32_t messages = 0;
  std::uint64_t connections = 0;  ///< bit n: messages of a connection whose number is n modulo 64
  std::uint64_t counts = 0;       ///< digest of the pairs (connection, number of its messages)
};

/// The digest of `BagChunk::counts`, of pairs in any order.
class BagCounts {
 public:
  void add(std::uint32_t connection, std::uint32_t count);
  std::uint64_t digest() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

/// The messages of the chunk that was parsed last.
class BagChunkIndex {
 public:
  void begin(const BagChunkData& chunk);
  void add(const BagMessage& message);
  /// The chunk ends after `size` bytes: it was not finished.
  void cut(std::uint32_t size) { chunk_.data.size = chunk_.data.packed = size; }
  const BagChunk& chunk();  ///< after the last message

  /// Data of one index record. Throws BagError: it contradicts the messages.
  void compare(std::uint32_t connection, std::uint32_t count, std::string_view data, const BagPlace& place);

  /// After the last index record. Throws BagError: a message stands in none.
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
