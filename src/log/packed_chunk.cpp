#include "log/packed_chunk.h"

#include <lz4frame.h>

#include <algorithm>
#include <stdexcept>

namespace robot_control {
namespace {

/// roslz4 needs independent blocks, a checksum over the content, and no size of the content in the frame.
std::string compressed(const std::string& content, Effort effort) {
  LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
  preferences.frameInfo.blockSizeID = LZ4F_max1MB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  preferences.compressionLevel = static_cast<int>(effort);
  std::string result(LZ4F_compressFrameBound(content.size(), &preferences), '\0');
  const std::size_t size =
      LZ4F_compressFrame(result.data(), result.size(), content.data(), content.size(), &preferences);
  if (LZ4F_isError(size) != 0) throw std::logic_error(std::string("LZ4: ") + LZ4F_getErrorName(size));
  result.resize(size);
  return result;
}

}  // namespace

void append_record(std::string& to, const BagFields& fields, std::string_view data) {
  ByteSink sink(to);
  sink.text(fields.bytes());
  sink.text(data);
}

void ChunkBuilder::add(std::uint32_t connection, std::int64_t time_ns, std::string_view message) {
  std::string& entries = entries_[connection];
  ByteSink index(entries);
  index.time(time_ns);
  index.number(static_cast<std::uint32_t>(content_.size()));
  BagFields fields(BagOp::kMessage);
  fields.number("conn", connection).time("time", time_ns);
  append_record(content_, fields, message);
  begin_ns_ = begin_ns_ == 0 ? time_ns : std::min(begin_ns_, time_ns);
  end_ns_ = std::max(end_ns_, time_ns);
}

PackedChunk ChunkBuilder::pack(Effort effort) {
  PackedChunk chunk{.begin_ns = begin_ns_, .end_ns = end_ns_};
  BagFields fields(BagOp::kChunk);
  fields.text("compression", "lz4").number("size", static_cast<std::uint32_t>(content_.size()));
  append_record(chunk.record, fields, compressed(content_, effort));
  for (const auto& [connection, entries] : entries_) {
    const auto count = static_cast<std::uint32_t>(entries.size() / kEntryBytes);
    BagFields index(BagOp::kIndex);
    index.number("ver", std::uint32_t{1}).number("conn", connection).number("count", count);
    append_record(chunk.index, index, entries);
    chunk.count[connection] = count;
  }
  content_.clear();
  entries_.clear();
  begin_ns_ = end_ns_ = 0;
  return chunk;
}

}  // namespace robot_control
