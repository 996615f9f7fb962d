#pragma once
/// A chunk of a bag holds connection and message records, one after the other, compressed with LZ4 as one stream, which
/// has a checksum.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "files/descriptor.h"
#include "log/bag/bag_record.h"

namespace robot_control {

inline constexpr std::uint64_t kMaxBag = std::uint64_t{16} << 30U;  ///< bytes; an hour of trace has 2.5 GB

/// A BagFile reads the bytes of a bag with pread. If another program shortens the file meanwhile, an error is reported;
/// with a mapping of the file the process would end.
class BagFile {
 public:
  /// Throws std::runtime_error if the path is not a regular file, cannot be read or is larger than kMaxBag.
  explicit BagFile(const std::string& path);

  std::uint64_t size() const { return size_; }

  /// Returns `count` bytes from `offset`, valid until the next call. Throws BagError for `field` if the file ends
  /// before.
  std::string_view read(std::uint64_t offset, std::size_t count, const std::string& field);

 private:
  std::size_t fill(std::uint64_t offset, std::size_t count);

  Descriptor file_;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  // offset of `window_` in the file
  std::string window_;
};

/// An inflated chunk has at most this many bytes.
inline constexpr std::uint32_t kMaxChunk = 256U << 20U;

/// Location of a chunk in the file, the properties that its header states, and a summary of its messages.
struct BagChunk {
  std::uint64_t record = 0;                 ///< offset in the file of the chunk's record
  std::uint64_t begin = 0;                  ///< offset in the file of its data
  std::uint32_t packed = 0;                 ///< bytes of data in the file
  std::uint32_t size = 0;                   ///< bytes of the inflated data
  std::uint64_t first_ns = 0, last_ns = 0;  ///< earliest and latest reception
  std::uint32_t messages = 0;
};

/// Reads the content of the chunk into `content`. It never inflates more than `size` bytes. Throws BagError if the
/// compression is broken or the content does not have `size` bytes.
void read_bag_chunk(BagFile& file, const BagChunk& chunk, std::string& content);

struct BagMessage {
  std::uint32_t connection = 0;  ///< its number in the bag
  std::uint32_t offset = 0;      ///< offset of its record in the content of the chunk, bytes
  std::uint64_t time_ns = 0;     ///< time of reception
  std::string_view data;         ///< serialized
};

/// The functions that receive the records of a chunk.
struct BagChunkUse {
  std::function<void(const BagRecord&)> connection;
  std::function<void(const BagMessage&)> message;
};

/// Passes each record of the content on to `use`. Throws BagError for the first record that is broken or of another
/// kind.
void parse_bag_chunk(std::string_view content, const BagChunk& chunk, const BagChunkUse& use);

}  // namespace robot_control
