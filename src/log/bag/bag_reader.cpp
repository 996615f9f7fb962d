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
    if (end.cut) throw BagError({.offset = file_.size()}, "index_pos", "the file ends without an index", true);
  } catch (const BagError& error) {
    const bool only_list_is_cut = error.ends() && behind_ && chunks_.size() == end.chunks;
    if (!end.cut && !only_list_is_cut) throw;
    commit();
    describe_cut(error, end.index);
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
  if (header.op() != BagOp::kBagHeader) throw BagError(header.place(), "op", "the first record is not a bag header");
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
      commit();                            // its content is sound
      constexpr std::size_t kLengths = 8;  // of the header and of the data
      const std::size_t left = std::min<std::uint64_t>(kLengths, file_.size() - at);
      const bool zeros = file_.read(at, left, "header_len") == std::string_view("\0\0\0\0\0\0\0\0", left);
      at = next_chunk(at + 1);
      if (!zeros || at < file_.size()) damaged_();  // zeros fill a bag of a fixed size
    }
  }
  commit();
  if (end.cut) return;
  behind_ = behind_ || at == end.index;
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
  if (!end.cut && at == end.index) {
    commit();
    behind_ = true;
  }
  const FileRecord record = read_file_record(file_, at);
  const BagHeader header = record.header();
  const BagOp op = header.op();
  if (op != BagOp::kIndex) {
    if (pending_ && !indexed_) refuse_index({.offset = at}, "op", "no index stands behind the chunk before");
    commit();
  }
  const bool list = op == BagOp::kConnection || op == BagOp::kChunkInfo;
  if (list && !behind_ && !end.cut) {
    throw BagError({.offset = at}, "index_pos",
                   "the chunks end here, but by the bag header at byte " + std::to_string(end.index));
  }
  behind_ = behind_ || list;
  expect_data(file_, record);
  if (op == BagOp::kChunk && !behind_) {
    read_chunk({.record = at, .begin = record.data, .packed = record.length, .size = header.u32("size")}, header);
  } else if (op == BagOp::kConnection) {
    ++defined_;
    add_connection(header, file_.read(record.data, record.length, "data"), {.offset = record.data});
  } else if (op == BagOp::kChunkInfo) {
    check_chunk_info(header);
    ++listed_;
  } else if (op == BagOp::kIndex) {
    check_index(file_.read(record.data, 8, "time"), {.offset = record.data});
  } else {
    throw BagError(header.place(), "op",
                   "record of kind " + std::to_string(static_cast<int>(op)) + " at a position where it has no meaning");
  }
  return record.data + record.length;
}

/// Returns the begin of the first chunk of a log at `at` or behind it; the size of the file: there is none.
std::uint64_t BagReader::next_chunk(std::uint64_t at) {
  // log/packed_chunk.cpp writes these fields; the size follows.
  static constexpr std::string_view kChunkBegin("\x28\0\0\0\x04\0\0\0op=\x05\x0f\0\0\0compression=lz4", 31);
  constexpr std::uint64_t kWindow = 1 << 16;
  for (; at + kChunkBegin.size() <= file_.size(); at += kWindow - kChunkBegin.size() + 1) {
    const std::size_t found = file_.read(at, std::min(kWindow, file_.size() - at), "data").find(kChunkBegin);
    if (found != std::string_view::npos) return at + found;
  }
  return file_.size();
}

void BagReader::read_chunk(BagChunk chunk, const BagHeader& header) {
  if (header.text("compression") != "lz4") {
    throw BagError(header.place(), "compression",
                   "'" + printable(header.text("compression"), 40) +
                       "' is none of a log; `rosbag compress --lz4` makes a bag that is read");
  }
  if (chunks_.size() == kMaxChunks) throw BagError(header.place(), "op", "the bag has more than 1048576 chunks");
  if (chunk.size > kMaxChunk) {
    throw BagError(header.place(), "size",
                   std::to_string(chunk.size) + " bytes; at most " + std::to_string(kMaxChunk) + " are read");
  }
  inflate(chunk);
  const auto add = [&](const BagMessage& message) {
    if (!connections_.contains(message.connection)) {
      throw BagError({.offset = message.offset, .chunk = chunk.record}, "conn",
                     "no connection record " + std::to_string(message.connection) + " stands before");
    }
    chunk.first_ns = chunk.messages == 0 ? message.time_ns : std::min(chunk.first_ns, message.time_ns);
    chunk.last_ns = std::max(chunk.last_ns, message.time_ns);
    ++chunk.messages;
  };
  const auto connection = [&](const BagRecord& record) {
    add_connection(record.header, record.data, record.data_place);
  };
  parse_bag_chunk(content_, chunk, {.connection = connection, .message = add});
  if (!chunks_.empty() && chunk.first_ns < chunks_.back().last_ns) {
    throw BagError(header.place(), "time", "the chunk begins before the end of the previous chunk");
  }
  pending_ = chunk;
  indexed_ = false;
}

void BagReader::check_index(std::string_view data, const BagPlace& place) {
  const std::uint64_t time_ns = bag_time_ns(data, place, "time");
  if (!pending_ || time_ns < pending_->first_ns || time_ns > pending_->last_ns) {
    refuse_index(place, "time", "the index does not belong to the previous chunk");
  }
  indexed_ = true;
}

/// The chunk before may be at a wrong place.
void BagReader::refuse_index(const BagPlace& place, const char* field, const char* problem) {
  if (!damaged_) pending_.reset();
  throw BagError(place, field, problem);
}

void BagReader::commit() {
  if (!pending_) return;
  chunks_.push_back(*std::exchange(pending_, std::nullopt));
  messages_ += chunks_.back().messages;
  if (early_) early_(*this, chunks_.back());
}

void BagReader::inflate(const BagChunk& chunk) {
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
  if (connections_.size() == kMaxConnections) {
    throw BagError(header.place(), "conn", "the bag has more than 16 connections");
  }
  connections_.emplace(number, connection);
}

void BagReader::check_chunk_info(const BagHeader& header) const {
  const std::uint64_t position = header.u64("chunk_pos");
  if (listed_ >= chunks_.size() || chunks_[listed_].record != position) {
    throw BagError(header.place(), "chunk_pos",
                   std::to_string(position) + " is not the begin of chunk " + std::to_string(listed_));
  }
  const BagChunk& chunk = chunks_[listed_];
  const auto expect = [&](const char* field, std::uint64_t time_ns) {
    if (header.time_ns(field) != time_ns) {
      throw BagError(header.place(), field, "contradicts the messages in the chunk");
    }
  };
  expect("start_time", chunk.first_ns);
  expect("end_time", chunk.last_ns);
}

void BagReader::describe_cut(const BagError& error, std::uint64_t index) {
  std::uint64_t end = 0;
  if (!chunks_.empty()) end = chunks_.back().begin + chunks_.back().packed;
  cut_ = "the bag has no end (index_pos is " + std::to_string(index) + ", the file has " +
         std::to_string(file_.size()) + " bytes): its recorder was stopped, or the copy is not whole. Read are " +
         std::to_string(messages_) + " messages in " + std::to_string(chunks_.size()) + " chunks, up to byte " +
         std::to_string(end) + "; there: " + error.what();
}

void BagReader::read(const BagChunk& chunk, const std::function<void(const BagMessage&)>& use) {
  inflate(chunk);
  const auto message = [&](const BagMessage& found) {
    if (!connections_.contains(found.connection)) {
      throw BagError({.offset = found.offset, .chunk = chunk.record}, "conn", "the file has changed while it was read");
    }
    use(found);
  };
  parse_bag_chunk(content_, chunk, {.connection = [](const BagRecord&) {}, .message = message});
}

}  // namespace robot_control
