#include "log/bag/bag_chunk.h"

#include <fcntl.h>
#include <lz4frame.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>

#include "files/input_file.h"
#include "log/bag/bag_error.h"

namespace robot_control {
namespace {

struct FreeContext {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

std::unique_ptr<LZ4F_dctx, FreeContext> make_context() {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  return std::unique_ptr<LZ4F_dctx, FreeContext>(context);
}

}  // namespace

void read_bag_chunk(BagFile& file, const BagChunk& chunk, std::string& content) {
  constexpr std::size_t kReadSize = std::size_t{1} << 16U;
  constexpr std::size_t kGrowth = std::size_t{1} << 20U;
  const auto context = make_context();
  std::uint64_t at = chunk.begin;
  const std::uint64_t end = chunk.begin + chunk.packed;
  content.clear();
  std::size_t made = 0;
  const auto refuse = [&](std::uint64_t place, const char* field, const std::string& problem) {
    content.clear();
    throw BagError({.offset = place}, field, problem);
  };
  for (bool ended = false; !ended;) {
    const std::string_view from = file.read(at, std::min<std::uint64_t>(kReadSize, end - at), "data");
    char surplus = 0;
    const bool full = made == chunk.size;
    if (!full && made == content.size()) content.resize(std::min<std::size_t>(chunk.size, made + kGrowth));
    std::size_t used = from.size(), room = full ? 1 : content.size() - made;
    const std::size_t result =
        LZ4F_decompress(context.get(), full ? &surplus : content.data() + made, &room, from.data(), &used, nullptr);
    if (LZ4F_isError(result) != 0) refuse(at, "data", "is not a valid lz4 stream");
    at += used;
    if (full && room > 0) {
      refuse(chunk.record, "size",
             "the chunk inflates to more than the " + std::to_string(chunk.size) + " bytes that it states");
    }
    made += room;
    ended = result == 0;
    if (!ended && used == 0 && room == 0) refuse(at, "data", "the compressed stream has no end");
  }
  if (at != end) refuse(at, "data", std::to_string(end - at) + " bytes stand behind the end of the compressed stream");
  if (made != chunk.size) {
    refuse(chunk.record, "size",
           "the chunk inflates to " + std::to_string(made) + " bytes instead of the " + std::to_string(chunk.size) +
               " that it says");
  }
}

void parse_bag_chunk(std::string_view content, const BagChunk& chunk, const BagChunkUse& use) {
  for (std::size_t at = 0; at < content.size();) {
    const BagRecord record = read_bag_record(content.substr(at), {.offset = at, .chunk = chunk.record});
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

BagFile::BagFile(const std::string& path) {
  if (const std::string problem = input_file_problem(path, kMaxBag); !problem.empty()) {
    throw std::runtime_error(problem);
  }
  file_ = Descriptor(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!file_.open()) throw std::runtime_error(std::strerror(errno));
  struct stat status {};
  if (fstat(file_.number(), &status) != 0 || !S_ISREG(status.st_mode))
    throw std::runtime_error("is no longer a regular file");
  size_ = static_cast<std::uint64_t>(status.st_size);
}

std::string_view BagFile::read(std::uint64_t offset, std::size_t count, const std::string& field) {
  const std::uint64_t available = offset < size_ ? size_ - offset : 0;
  if (count > available) {
    throw BagError({.offset = offset}, field,
                   std::to_string(count) + " bytes, but the file ends after " + std::to_string(available), true);
  }
  if (offset < begin_ || offset + count > begin_ + window_.size()) {
    constexpr std::size_t kReadAhead = std::size_t{4} << 20U;  // a whole bag of a black box, which may be overwritten
    const std::size_t got =
        fill(offset, static_cast<std::size_t>(std::min<std::uint64_t>(std::max(count, kReadAhead), available)));
    if (got < count) throw BagError({.offset = offset + got}, field, "the file became shorter while it was read", true);
  }
  return std::string_view(window_).substr(offset - begin_, count);
}

std::size_t BagFile::fill(std::uint64_t offset, std::size_t count) {
  begin_ = offset;
  window_.resize(count);
  std::size_t got = 0;
  while (got < count) {
    const ssize_t more = pread(file_.number(), window_.data() + got, count - got, static_cast<off_t>(offset + got));
    if (more < 0 && errno == EINTR) continue;
    if (more < 0) throw BagError({.offset = offset + got}, "data", std::strerror(errno));
    if (more == 0) break;
    got += static_cast<std::size_t>(more);
  }
  window_.resize(got);
  return got;
}

}  // namespace robot_control
