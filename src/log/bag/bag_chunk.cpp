#include "log/bag/bag_chunk.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>

namespace robot_control {
namespace {

/// An Inflater inflates one compressed stream.
class Inflater {
 public:
  struct Progress {
    std::size_t used, made;
    bool ended;
    const char* problem;  // nullptr: none
  };

  Inflater() = default;
  virtual ~Inflater() = default;
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  virtual Progress step(std::string_view from, char* to, std::size_t room) = 0;
};

class Bz2Inflater : public Inflater {
 public:
  Bz2Inflater() { BZ2_bzDecompressInit(&stream_, 0, 0); }
  ~Bz2Inflater() override { BZ2_bzDecompressEnd(&stream_); }

  Progress step(std::string_view from, char* to, std::size_t room) override {
    stream_.next_in = const_cast<char*>(from.data());  // NOLINT(*-const-cast): it only reads
    stream_.avail_in = static_cast<unsigned>(from.size());
    stream_.next_out = to;
    stream_.avail_out = static_cast<unsigned>(room);
    const int result = BZ2_bzDecompress(&stream_);
    const char* problem = nullptr;
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();
    if (result != BZ_OK && result != BZ_STREAM_END) problem = "is no sound bz2 stream";
    return {.used = from.size() - stream_.avail_in,
            .made = room - stream_.avail_out,
            .ended = result == BZ_STREAM_END,
            .problem = problem};
  }

 private:
  bz_stream stream_{};
};

class Lz4Inflater : public Inflater {
 public:
  Lz4Inflater() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context_, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  }
  ~Lz4Inflater() override { LZ4F_freeDecompressionContext(context_); }

  Progress step(std::string_view from, char* to, std::size_t room) override {
    std::size_t used = from.size(), made = room;
    const std::size_t result = LZ4F_decompress(context_, to, &made, from.data(), &used, nullptr);
    const bool failed = LZ4F_isError(result) != 0;
    return {.used = failed ? 0 : used,
            .made = failed ? 0 : made,
            .ended = !failed && result == 0,
            .problem = failed ? "is no sound lz4 stream" : nullptr};
  }

 private:
  LZ4F_dctx* context_ = nullptr;
};

void inflate(BagFile& file, const BagChunkData& chunk, Inflater& inflater, std::string& content) {
  constexpr std::size_t kPiece = std::size_t{1} << 16U;
  constexpr std::size_t kGrowth = std::size_t{1} << 20U;
  std::uint64_t at = chunk.begin;
  const std::uint64_t end = chunk.begin + chunk.packed;
  std::size_t made = 0;
  const auto refuse = [&](const char* field, const std::string& problem) {
    content.clear();
    throw BagError({.offset = at}, field, problem);
  };
  for (bool ended = false; !ended;) {
    const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, end - at));
    const std::string_view from = file.read(at, piece, "data");
    char surplus = 0;
    const bool full = made == chunk.size;
    if (!full && made == content.size()) content.resize(std::min<std::size_t>(chunk.size, made + kGrowth));
    const Inflater::Progress progress =
        full ? inflater.step(from, &surplus, 1) : inflater.step(from, content.data() + made, content.size() - made);
    at += progress.used;
    if (progress.problem != nullptr) refuse("data", progress.problem);
    if (full && progress.made > 0) {
      at = chunk.record;
      refuse("size", "the chunk inflates to more than the " + std::to_string(chunk.size) + " bytes that it says");
    }
    made += progress.made;
    ended = progress.ended;
    if (!ended && progress.used == 0 && progress.made == 0) refuse("data", "the compressed stream has no end");
  }
  if (at != end) refuse("data", std::to_string(end - at) + " bytes stand behind the end of the compressed stream");
  if (made != chunk.size) {
    at = chunk.record;
    refuse("size", "the chunk inflates to " + std::to_string(made) + " bytes instead of the " +
                       std::to_string(chunk.size) + " that it says");
  }
}

}  // namespace

BagPlace BagChunkData::place(std::uint64_t offset) const {
  if (compression == BagCompression::kNone) return {.offset = begin + offset};
  return {.offset = offset, .chunk = record};
}

void read_bag_chunk(BagFile& file, const BagChunkData& chunk, std::string& content) {
  content.clear();
  if (chunk.compression == BagCompression::kNone) {
    content = file.read(chunk.begin, chunk.size, "data");
  } else if (chunk.compression == BagCompression::kBz2) {
    Bz2Inflater inflater;
    inflate(file, chunk, inflater, content);
  } else {
    Lz4Inflater inflater;
    inflate(file, chunk, inflater, content);
  }
}

void parse_bag_chunk(std::string_view content, const BagChunkData& chunk, const BagChunkUse& use, std::size_t& at) {
  while (at < content.size()) {
    const BagRecord record = read_bag_record(content.substr(at), chunk.place(at));
    const BagOp op = record.header.op();
    if (op == BagOp::kConnection) {
      use.connection(record);
    } else if (op == BagOp::kMessage) {
      use.message({.connection = record.header.u32("conn"),
                   .offset = static_cast<std::uint32_t>(at),
                   .time_ns = record.header.time_ns("time"),
                   .data = record.data});
    } else {
      throw BagError(record.header.place(), "op", "a chunk holds connections and messages, nothing else");
    }
    at += record.size;
  }
}

}  // namespace robot_control
