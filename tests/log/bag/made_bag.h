#pragma once
/// A valid bag that is made field by field, so that a test can spoil exactly one thing.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "log/bag/bag_chunk.h"

namespace robot_control {

std::string little_endian(std::uint64_t number, std::size_t bytes);
std::string bag_field(const std::string& name, const std::string& value);
std::string bag_record(const std::string& header, const std::string& data);
std::string packed(const std::string& content);  ///< as an lz4 stream

struct MadeMessage {
  std::uint32_t connection;
  std::uint64_t time_ns;
  std::string data;

  bool operator==(const MadeMessage&) const = default;
};

/// Errors of the bag.
struct BagFlaw {
  std::uint32_t start_in_list = 0;     ///< s, added to the start of each chunk info
  std::uint32_t size_of_chunk = 0;     ///< added to the size that a chunk states
  std::uint64_t index_pos = 0;         ///< added
  std::uint32_t chunk_count = 0;       ///< added
  std::uint32_t connection_count = 0;  ///< added
  std::string other_type = {};         ///< type of the connections in the list behind the chunks
  std::string behind_stream = {};      ///< bytes behind the compressed stream of each chunk
  std::string compression = "lz4";     ///< as the chunks name it
  bool unfinished = false;             ///< as its writer leaves it at SIGKILL: neither index nor list
};

struct MadeBag {
  std::string bytes;
  std::vector<std::vector<MadeMessage>> chunks;
  std::vector<std::pair<std::size_t, std::size_t>> records;  ///< offset and size of each record behind the bag header
};

/// `chunks` of `messages` each, of two connections, times in steps of 10 ms from 100 s on.
MadeBag make_bag(std::size_t chunks, std::size_t messages, const BagFlaw& flaw = {});

}  // namespace robot_control
