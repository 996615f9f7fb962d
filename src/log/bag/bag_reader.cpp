#include "log/bag/bag_reader.h"

#include <algorithm>
#include <utility>

#include "files/message_text.h"

namespace robot_control {
namespace {

/// The header of a record in the file and the offset of its data. The header's bytes are copied, because the next read
/// moves the file's window.
struct FileRecord {
  std::string bytes;
  std::uint64_t data = 0;  // offset
  std::uint32_t length = 0;
  std::uint64_t place = 0;

  BagHeader header() const { return {bytes, {.offset = place + 4}}; }
};

FileRecord read_file_record(BagFile& file, std::uint64_t at) {
  const auto length = bag_number<std::uint32_t>(file.read(at, 4, "header_len"));
  if (length > kMaxBagHeader) {
    throw BagError({.offset = at}, "header_len", std::to_string(length) + " bytes; at most 65536 are read");
  }
  FileRecord record;
  record.place = at;
  record.bytes = file.read(at + 4, length, "header");
  record.length = bag_number<std::uint32_t>(file.read(at + 4 + length, 4, "data_len"));
  record.data = at + 8 + length;
  return record;
}

void expect_data(const BagFile& file, const FileRecord& record) {
  const std::uint64_t available = file.size() - record.data;
  if (record.length <= available) return;
  throw BagError({.offset = record.data - 4}, "data_len",
                 std::to_string(record.length) + " bytes, but the file ends after " + std::to_string(available), true);
}

BagCompression compression_of(const BagHeader& header) {
  const std::string_view name = header.text("compression");
  if (name == "none") return BagCompression::kNone;
  if (name == "bz2") return BagCompression::kBz2;
  if (name == "lz4") return BagCompression::kLz4;
  throw BagError(header.place(), "compression", "'" + printable(name, 40) + "' is none of none, bz2, lz4");
}

void expect_version_1(const BagHeader& header) {
  if (header.u32("ver") != 1) throw BagError(header.place(), "ver", "only version 1 is known");
}

}  // namespace

struct BagReader::End {
  std::uint64_t index = 0;  // offset of the first record behind the chunks
  std::uint32_t connections = 0, chunks = 0;
  std::uint64_t first_record = 0;
  bool cut = false;
};

BagReader::BagReader(const std::string& path, Early early, Damaged damaged)
    : file_(path), early_(std::move(early)), damaged_(std::move(damaged)) {
  const End end = read_bag_header();
  try {
    read_records(end);
  } catch (const BagError& error) {
    const bool only_list_is_cut = error.ends() && behind_ && chunks_.size() == end.chunks;
    if (!end.cut && !only_list_is_cut) throw;
    if (pending_ && error.ends()) commit();  // the chunk is complete, its index is not
    describe_cut(error, end.index);
  }
  if (end.cut && cut_.empty()) {
    describe_cut(BagError({.offset = file_.size()}, "index_pos", "the file ends without an index", true), end.index);
  }
  early_ = {};
  inflated_record_.reset();
  content_ = {};
}

BagReader::End BagReader::read_bag_header() {
  if (file_.size() < kBagMagic.size() || file_.read(0, kBagMagic.size(), "version") != kBagMagic) {
    const std::size_t shown = std::min<std::uint64_t>(file_.size(), kBagMagic.size());
    throw BagError({}, "version",
                   "the file begins with '" + printable(file_.read(0, shown, "version"), 40) +
                       "' instead of '#ROSBAG V2.0' and a line end");
  }
  const FileRecord record = read_file_record(file_, kBagMagic.size());
  expect_data(file_, record);
  const BagHeader header = record.header();
  if (header.op() != BagOp::kBagHeader) throw BagError(header.place(), "op", "the first record is no bag header");
  if (header.has("encryptor") && !header.text("encryptor").empty()) {
    throw BagError(header.place(), "encryptor", "encrypted bags are not read");
  }
  End end{.index = header.u64("index_pos"),
          .connections = header.u32("conn_count"),
          .chunks = header.u32("chunk_count"),
          .first_record = record.data + record.length};
  end.cut = end.index == 0 || end.index > file_.size();
  if (!end.cut && end.index < end.first_record) {
    throw BagError(header.place(), "index_pos", std::to_string(end.index) + " is within the bag header");
  }
  return end;
}

void BagReader::read_records(const End& end) {
  std::uint64_t at = end.first_record;
  while (at < file_.size()) {
    try {
      at = read_record(end, at);
    } catch (const BagError&) {
      if (!damaged_) throw;
      if (pending_) commit();              // its content is sound
      constexpr std::size_t kLengths = 8;  // of the header and of the data
      const std::size_t left = std::min<std::uint64_t>(kLengths, file_.size() - at);
      const bool zeros = file_.read(at, left, "header_len") == std::string_view("\0\0\0\0\0\0\0\0", left);
      at = next_chunk(at + 1);
      if (!zeros || at < file_.size()) damaged_();  // zeros fill a bag of a fixed size
    }
  }
  if (end.cut) return end_chunk();
  if (at == end.index) begin_list();
  const auto expect = [&](std::size_t count, std::size_t announced, const char* field, const char* what) {
    if (count == announced) return;
    throw BagError({.offset = kBagMagic.size()}, field,
                   std::to_string(announced) + ", but there are " + std::to_string(count) + what, listed_ < end.chunks);
  };
  if (!behind_) throw BagError({.offset = kBagMagic.size()}, "index_pos", "no record begins there");
  expect(connections_.size(), end.connections, "conn_count", " connections");
  expect(defined_, end.connections, "conn_count", " connection records behind the chunks");
  expect(chunks_.size(), end.chunks, "chunk_count", " chunks");
  expect(listed_, end.chunks, "chunk_count", " chunk info records");
}

/// Returns the end of the record.
std::uint64_t BagReader::read_record(const End& end, std::uint64_t at) {
  if (!end.cut && at == end.index) begin_list();
  const FileRecord record = read_file_record(file_, at);
  const BagHeader header = record.header();
  const BagOp op = header.op();
  if (op != BagOp::kIndex) end_chunk();
  if (!behind_ && (op == BagOp::kConnection || op == BagOp::kChunkInfo)) {
    if (!end.cut) {
      throw BagError({.offset = at}, "index_pos",
                     "the chunks end here, but the bag header says at byte " + std::to_string(end.index));
    }
    behind_ = true;
  }
  const BagPlace data{.offset = record.data};
  const bool chunk = op == BagOp::kChunk && !behind_;
  if (chunk && end.cut && (record.length == 0 || record.length > file_.size() - record.data)) {
    read_unfinished(at, header, record.data);
  }
  expect_data(file_, record);
  if (chunk) {
    read_chunk(at, header, record.data, record.length);
  } else if (op == BagOp::kIndex && pending_) {
    expect_version_1(header);
    index_.compare(header.u32("conn"), header.u32("count"), file_.read(record.data, record.length, "data"), data);
  } else if (op == BagOp::kConnection) {
    ++defined_;
    add_connection(header, file_.read(record.data, record.length, "data"), data);
  } else if (op == BagOp::kChunkInfo) {
    check_chunk_info(listed_++, header, file_.read(record.data, record.length, "data"), data);
  } else {
    throw BagError(header.place(), "op",
                   "record of kind " + std::to_string(static_cast<int>(op)) + " at a place where it has no meaning");
  }
  return record.data + record.length;
}

/// Returns the begin of the first chunk of a log at `at` or behind it; the size of the file: there is none.
std::uint64_t BagReader::next_chunk(std::uint64_t at) {
  // log/packed_chunk.cpp writes these fields; the size follows.
  static constexpr std::string_view kBegin("\x28\0\0\0\x04\0\0\0op=\x05\x0f\0\0\0compression=lz4", 31);
  constexpr std::uint64_t kWindow = 1 << 16;
  for (; at + kBegin.size() <= file_.size(); at += kWindow - kBegin.size() + 1) {
    const std::size_t found = file_.read(at, std::min(kWindow, file_.size() - at), "data").find(kBegin);
    if (found != std::string_view::npos) return at + found;
  }
  return file_.size();
}

void BagReader::begin_list() {
  end_chunk();
  behind_ = true;
}

void BagReader::end_chunk() {
  if (!pending_) return;
  index_.finish();
  commit();
}

void BagReader::read_chunk(std::uint64_t record, const BagHeader& header, std::uint64_t begin, std::uint32_t length) {
  BagChunkData chunk{.record = record,
                     .begin = begin,
                     .packed = length,
                     .size = header.u32("size"),
                     .compression = compression_of(header)};
  if (chunks_.size() == kMaxChunks) throw BagError(header.place(), "op", "the bag has more than 1048576 chunks");
  if (chunk.compression == BagCompression::kNone && chunk.size != chunk.packed) {
    throw BagError(header.place(), "size",
                   std::to_string(chunk.size) + " bytes, but the data have " + std::to_string(chunk.packed));
  }
  if (chunk.compression != BagCompression::kNone) inflated_ += chunk.size;
  const std::uint64_t max_inflated = kInflatesAnyhow + kInflatesTo * file_.size();
  if (chunk.size > kMaxChunk || inflated_ > max_inflated) {
    throw BagError(header.place(), "size",
                   "the bag inflates to " + std::to_string(std::max<std::uint64_t>(inflated_, chunk.size)) +
                       " bytes or more, with a chunk of " + std::to_string(chunk.size) + "; read are " +
                       std::to_string(max_inflated) + " in all, " + std::to_string(kMaxChunk) +
                       " in a chunk. If it is sound, `rosbag decompress` or `rosbag filter` makes one that is read");
  }
  index_.begin(chunk);
  inflate(chunk);
  std::size_t at = 0;
  parse(at, chunk);
  pending_ = true;
}

void BagReader::read_unfinished(std::uint64_t record, const BagHeader& header, std::uint64_t begin) {
  // The sizes in the header are missing: rosbag writes them when the chunk is full.
  const auto size = static_cast<std::uint32_t>(std::min<std::uint64_t>(file_.size() - begin, kMaxChunk));
  const BagChunkData chunk{.record = record, .begin = begin, .packed = size, .size = size};
  if (compression_of(header) != BagCompression::kNone) {
    throw BagError(header.place(), "size", "its recorder did not finish the last chunk, or the file ends in it", true);
  }
  index_.begin(chunk);
  inflate(chunk);
  std::size_t sound = 0;
  const auto keep = [&] {
    index_.cut(static_cast<std::uint32_t>(sound));
    commit();
  };
  try {
    parse(sound, chunk);
  } catch (const BagError&) {
    keep();
    throw;
  }
  keep();
  throw BagError({.offset = chunk.begin + sound}, "size",
                 "its recorder did not finish the last chunk, or the file ends in it", true);
}

void BagReader::parse(std::size_t& at, const BagChunkData& chunk) {
  std::uint32_t known = 0;
  bool any = false;
  const auto add = [&](const BagMessage& message) {
    if (!any || message.connection != known) {
      if (!connections_.contains(message.connection)) {
        throw BagError(chunk.place(message.offset), "conn",
                       "no connection record " + std::to_string(message.connection) + " stands before");
      }
      known = message.connection;
      any = true;
    }
    index_.add(message);
  };
  const auto connection = [&](const BagRecord& record) {
    add_connection(record.header, record.data, record.data_place);
  };
  parse_bag_chunk(content_, chunk, {.connection = connection, .message = add}, at);
}

void BagReader::commit() {
  pending_ = false;
  chunks_.push_back(index_.chunk());
  messages_ += chunks_.back().messages;
  if (early_) early_(*this, chunks_.back());
}

void BagReader::inflate(const BagChunkData& chunk) {
  if (inflated_record_ == chunk.record) return;
  inflated_record_.reset();
  read_bag_chunk(file_, chunk, content_);
  inflated_record_ = chunk.record;
}

void BagReader::add_connection(const BagHeader& header, std::string_view data, const BagPlace& place) {
  const BagHeader fields(data, place);
  const BagConnection connection{.topic = std::string(header.text("topic")),
                                 .type = std::string(fields.text("type")),
                                 .md5sum = std::string(fields.text("md5sum")),
                                 .definition = std::string(fields.text("message_definition"))};
  const std::uint32_t number = header.u32("conn");
  const auto known = connections_.find(number);
  if (known != connections_.end()) {
    if (known->second == connection) return;
    throw BagError(header.place(), "conn", "another connection record " + std::to_string(number) + " stands before");
  }
  connection_bytes_ += data.size() + connection.topic.size();
  if (connections_.size() == kMaxConnections || connection_bytes_ > kMaxConnectionBytes) {
    throw BagError(header.place(), "conn", "the bag has more than 10000 connections, or 64 MiB of them");
  }
  connections_.emplace(number, connection);
}

void BagReader::check_chunk_info(std::size_t number, const BagHeader& header, std::string_view data,
                                 const BagPlace& place) const {
  constexpr std::size_t kEntry = 8;
  expect_version_1(header);
  const std::uint64_t position = header.u64("chunk_pos");
  if (number >= chunks_.size() || chunks_[number].data.record != position) {
    throw BagError(header.place(), "chunk_pos",
                   std::to_string(position) + " is not the begin of chunk " + std::to_string(number));
  }
  const BagChunk& chunk = chunks_[number];
  const std::uint32_t count = header.u32("count");
  if (data.size() != std::size_t{count} * kEntry) {
    throw BagError(
        place, "count",
        std::to_string(count) + " entries of 8 bytes, but the data have " + std::to_string(data.size()) + " bytes");
  }
  BagCounts counts;
  for (std::size_t at = 0; at < data.size(); at += kEntry) {
    counts.add(bag_number<std::uint32_t>(data.substr(at)), bag_number<std::uint32_t>(data.substr(at + 4)));
  }
  if (counts.digest() != chunk.counts) throw BagError(place, "count", "contradicts the messages in the chunk");
  const auto expect = [&](const char* field, std::uint64_t time_ns) {
    if (chunk.messages > 0 && header.time_ns(field) != time_ns) {
      throw BagError(header.place(), field, "contradicts the messages in the chunk");
    }
  };
  expect("start_time", chunk.first_ns);
  expect("end_time", chunk.last_ns);
}

void BagReader::describe_cut(const BagError& error, std::uint64_t index) {
  std::uint64_t end = 0;
  for (const BagChunk& chunk : chunks_) end = chunk.data.begin + chunk.data.packed;
  cut_ = "the bag has no end (index_pos is " + std::to_string(index) + ", the file has " +
         std::to_string(file_.size()) + " bytes): its recorder was stopped, or the copy is not whole. Read are " +
         std::to_string(messages_) + " messages in " + std::to_string(chunks_.size()) + " chunks, up to byte " +
         std::to_string(end) + "; there: " + error.what();
}

void BagReader::read(const BagChunk& chunk, const std::function<void(const BagMessage&)>& use) {
  inflate(chunk.data);
  // Behind the correct part of an unfinished chunk there may be broken data.
  const std::string_view content = std::string_view(content_).substr(0, chunk.data.size);
  const auto message = [&](const BagMessage& found) {
    if (!connections_.contains(found.connection)) {
      throw BagError(chunk.data.place(found.offset), "conn", "the file has changed while it was read");
    }
    use(found);
  };
  std::size_t at = 0;
  parse_bag_chunk(content, chunk.data, {.connection = [](const BagRecord&) {}, .message = message}, at);
}

}  // namespace robot_control
