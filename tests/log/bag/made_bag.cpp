#include "log/bag/made_bag.h"

#include <lz4frame.h>

#include <map>

namespace robot_control {
namespace {

constexpr std::uint64_t kSecond = 1'000'000'000;

std::string number(const std::string& name, std::uint64_t value, std::size_t bytes) {
  return bag_field(name, little_endian(value, bytes));
}

std::string time_of(std::uint64_t ns) {
  return little_endian(ns / kSecond, 4) + little_endian(ns % kSecond, 4);
}

std::string connection_record(std::uint32_t connection, const std::string& type) {
  const std::string topic = connection == 0 ? "/odom" : "/imu";
  return bag_record(number("op", 7, 1) + number("conn", connection, 4) + bag_field("topic", topic),
                    bag_field("topic", topic) + bag_field("type", type.empty() ? "std_msgs/String" : type) +
                        bag_field("md5sum", "992ce8a1687cec8c8bd883ec73ca41d1") +
                        bag_field("message_definition", "string data\n") + bag_field("callerid", "/recorder"));
}

struct MadeChunk {
  std::string content;
  std::map<std::uint32_t, std::vector<std::pair<std::uint64_t, std::uint32_t>>> index;  // time, offset
};

MadeChunk make_chunk(const std::vector<MadeMessage>& messages, bool first) {
  MadeChunk chunk;
  if (first) chunk.content = connection_record(0, "") + connection_record(1, "");
  for (const MadeMessage& message : messages) {
    chunk.index[message.connection].emplace_back(message.time_ns, chunk.content.size());
    chunk.content += bag_record(
        number("op", 2, 1) + number("conn", message.connection, 4) + bag_field("time", time_of(message.time_ns)),
        message.data);
  }
  return chunk;
}

std::string index_records(const MadeChunk& chunk) {
  std::string records;
  for (const auto& [connection, entries] : chunk.index) {
    std::string data;
    for (const auto& [time_ns, offset] : entries) data += time_of(time_ns) + little_endian(offset, 4);
    records += bag_record(
        number("op", 4, 1) + number("ver", 1, 4) + number("conn", connection, 4) + number("count", entries.size(), 4),
        data);
  }
  return records;
}

std::string chunk_info(std::uint64_t position, const MadeChunk& chunk, const std::vector<MadeMessage>& messages,
                       const BagFlaw& flaw) {
  std::string counts;
  for (const auto& [connection, entries] : chunk.index) {
    counts += little_endian(connection, 4) + little_endian(entries.size(), 4);
  }
  return bag_record(number("op", 6, 1) + number("ver", 1, 4) + number("chunk_pos", position, 8) +
                        bag_field("start_time", time_of(messages.front().time_ns + flaw.start_in_list * kSecond)) +
                        bag_field("end_time", time_of(messages.back().time_ns)) +
                        number("count", chunk.index.size(), 4),
                    counts);
}

std::string bag_header(std::uint64_t index_pos, std::uint64_t connections, std::uint64_t chunks) {
  const std::string header = number("op", 3, 1) + number("index_pos", index_pos, 8) +
                             number("conn_count", connections, 4) + number("chunk_count", chunks, 4);
  return "#ROSBAG V2.0\n" + bag_record(header, std::string(200, ' '));
}

}  // namespace

std::string little_endian(std::uint64_t number, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>(number >> (8 * i) & 0xFFU);
  return text;
}

std::string bag_field(const std::string& name, const std::string& value) {
  return little_endian(name.size() + 1 + value.size(), 4) + name + "=" + value;
}

std::string bag_record(const std::string& header, const std::string& data) {
  return little_endian(header.size(), 4) + header + little_endian(data.size(), 4) + data;
}

std::string packed(const std::string& content) {
  std::string result;
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;  // as roslz4 writes it
  result.resize(LZ4F_compressFrameBound(content.size(), &preferences));
  result.resize(LZ4F_compressFrame(result.data(), result.size(), content.data(), content.size(), &preferences));
  return result;
}

MadeBag make_bag(std::size_t chunks, std::size_t messages, const BagFlaw& flaw) {
  MadeBag bag;
  std::string body, list;
  const std::size_t begin = bag_header(0, 0, 0).size();
  const auto add = [&](const std::string& record) {
    bag.records.emplace_back(begin + body.size(), record.size());
    body += record;
  };
  std::uint64_t time_ns = 100 * kSecond;
  for (std::size_t i = 0; i < chunks; ++i) {
    auto& of_chunk = bag.chunks.emplace_back();
    for (std::size_t k = 0; k < messages; ++k, time_ns += kSecond / 100) {
      const auto connection = static_cast<std::uint32_t>(k % 3 == 0);
      of_chunk.push_back({connection, time_ns, std::string(5 + k % 40, static_cast<char>('a' + k % 26))});
    }
    const MadeChunk chunk = make_chunk(of_chunk, i == 0);
    const std::uint64_t position = begin + body.size();
    const std::string data = packed(chunk.content) + flaw.behind_stream;
    const std::string header = number("op", 5, 1) + bag_field("compression", flaw.compression);
    add(bag_record(header + number("size", chunk.content.size() + flaw.size_of_chunk, 4), data));
    if (flaw.unfinished && i + 1 == chunks) break;
    add(index_records(chunk));
    list += chunk_info(position, chunk, of_chunk, flaw);
  }
  const std::uint64_t index = flaw.unfinished ? 0 : begin + body.size() + flaw.index_pos;
  if (!flaw.unfinished) {
    add(connection_record(0, flaw.other_type));
    add(connection_record(1, flaw.other_type));
    body += list;
  }
  bag.bytes = bag_header(index, flaw.unfinished ? 0 : 2 + flaw.connection_count,
                         flaw.unfinished ? 0 : chunks + flaw.chunk_count) +
              body;
  return bag;
}

}  // namespace robot_control
