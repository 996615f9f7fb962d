#include "log/bag/bag_index.h"

#include <algorithm>
#include <map>

namespace robot_control {

void BagCounts::add(std::uint32_t connection, std::uint32_t count) {
  std::uint64_t mixed = ((std::uint64_t{connection} << 32U) | count) + 0x9E3779B97F4A7C15U;  // SplitMix64
  mixed = (mixed ^ (mixed >> 30U)) * 0xBF58476D1CE4E5B9U;
  mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EBU;
  sum_ += mixed ^ (mixed >> 31U);
}

void BagChunkIndex::begin(const BagChunkData& chunk) {
  chunk_ = {.data = chunk};
  entries_.clear();
}

void BagChunkIndex::add(const BagMessage& message) {
  entries_.push_back(
      {.offset = message.offset, .connection = message.connection, .time_ns = message.time_ns, .indexed = false});
}

const BagChunk& BagChunkIndex::chunk() {
  std::map<std::uint32_t, std::uint32_t> counts;
  chunk_.messages = static_cast<std::uint32_t>(entries_.size());
  chunk_.connections = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    chunk_.first_ns = i == 0 ? entry.time_ns : std::min(chunk_.first_ns, entry.time_ns);
    chunk_.last_ns = i == 0 ? entry.time_ns : std::max(chunk_.last_ns, entry.time_ns);
    chunk_.connections |= std::uint64_t{1} << (entry.connection % 64U);
    ++counts[entry.connection];
  }
  BagCounts digest;
  for (const auto& [connection, count] : counts) digest.add(connection, count);
  chunk_.counts = digest.digest();
  return chunk_;
}

void BagChunkIndex::compare(std::uint32_t connection, std::uint32_t count, std::string_view data,
                            const BagPlace& place) {
  constexpr std::size_t kEntry = 12;
  if (data.size() != std::size_t{count} * kEntry) {
    throw BagError(
        place, "count",
        std::to_string(count) + " entries of 12 bytes, but the data have " + std::to_string(data.size()) + " bytes");
  }
  for (std::size_t at = 0; at < data.size(); at += kEntry) {
    const std::uint64_t time_ns = bag_time_ns(data.substr(at), place + at, "time");
    const auto offset = bag_number<std::uint32_t>(data.substr(at + 8));
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), offset,
                                        [](const Entry& entry, std::uint32_t value) { return entry.offset < value; });
    if (found == entries_.end() || found->offset != offset || found->connection != connection) {
      throw BagError(place + (at + 8), "offset",
                     "no message of connection " + std::to_string(connection) + " is at byte " +
                         std::to_string(offset) + " of the chunk");
    }
    if (found->time_ns != time_ns) throw BagError(place + at, "time", "contradicts that of the message itself");
    if (found->indexed) throw BagError(place + (at + 8), "offset", "the message is in the index twice");
    found->indexed = true;
  }
}

void BagChunkIndex::finish() const {
  for (const Entry& entry : entries_) {
    if (!entry.indexed) throw BagError(chunk_.data.place(entry.offset), "offset", "the message is not in the index");
  }
}

}  // namespace robot_control
