#pragma once
/// A ROS bag consists of records (http://wiki.ros.org/Bags/Format/2.0). A record has four bytes with the header's
/// length, the header, four bytes with the length of the data, and the data. A header is a sequence of fields, each
/// with four bytes of length and `name=value`. Numbers are little-endian. Every length is compared with the available
/// bytes before anything is read.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "log/bag/bag_error.h"

namespace robot_control {

inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

inline constexpr std::uint32_t kMaxBagHeader =
    1U << 16U;  ///< bytes; headers of rosbag have less than 200, plus the topic's name

/// The values of the field `op`.
enum class BagOp : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

/// Returns the little-endian number at the beginning of `bytes`, which are long enough.
template <typename Number>
Number bag_number(std::string_view bytes) {
  Number value = 0;
  for (std::size_t i = sizeof(Number); i-- > 0;) {
    value = static_cast<Number>((value << 8U) | static_cast<unsigned char>(bytes[i]));
  }
  return value;
}

/// Returns seconds and nanoseconds, four bytes each, as ns. Throws BagError if the nanoseconds make a second or more.
std::uint64_t bag_time_ns(std::string_view bytes, const BagPlace& place, const std::string& field);

/// The fields of one header, as views into the bytes of the header.
class BagHeader {
 public:
  /// Throws BagError if a field is longer than the header, has no `=` or no name, or occurs twice, or if there are more
  /// than kMaxFields.
  BagHeader(std::string_view bytes, const BagPlace& place);

  /// The following functions return the value of a field. They throw BagError if the field is missing or has another
  /// size.
  BagOp op() const;
  std::uint32_t u32(std::string_view name) const {
    return bag_number<std::uint32_t>(sized(name, sizeof(std::uint32_t)).value);
  }
  std::uint64_t u64(std::string_view name) const {
    return bag_number<std::uint64_t>(sized(name, sizeof(std::uint64_t)).value);
  }
  std::uint64_t time_ns(std::string_view name) const;
  std::string_view text(std::string_view name) const;

  bool has(std::string_view name) const { return find(name) != nullptr; }
  const BagPlace& place() const { return place_; }

 private:
  struct Field {
    std::string_view name, value;
    std::uint64_t offset;  // offset of the value in the header
  };
  static constexpr std::size_t kMaxFields = 32;

  const Field* find(std::string_view name) const;
  const Field& sized(std::string_view name, std::size_t size) const;

  BagPlace place_;
  std::array<Field, kMaxFields> fields_;
  std::size_t count_ = 0;
};

/// A record in memory.
struct BagRecord {
  BagHeader header;
  std::string_view data;
  BagPlace data_place;
  std::size_t size;  ///< bytes of the whole record
};

/// Returns the record at the beginning of `bytes`. Throws BagError, with `ends` if `bytes` end within the record.
BagRecord read_bag_record(std::string_view bytes, const BagPlace& place);

}  // namespace robot_control
