#pragma once
/// The record of ROS bags (http://wiki.ros.org/Bags/Format/2.0): four bytes of length, a header of so many bytes, four
/// bytes of length, data of so many bytes. A header is a sequence of fields, each of four bytes of length and
/// `name=value`; numbers are little-endian. Every length is compared with what there is before anything is read.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "bags/bag_error.h"

namespace robot_control {

inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

inline constexpr std::uint32_t kMaxBagHeader = 1U << 16U;  ///< bytes; rosbag's own have less than 200, and a topic

/// Values of the field `op`.
enum class BagOp : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

/// Little-endian number at the begin of `bytes`, which holds it.
template <typename Number>
Number bag_number(std::string_view bytes) {
  Number value = 0;
  for (std::size_t i = sizeof(Number); i-- > 0;) {
    value = static_cast<Number>((value << 8U) | static_cast<unsigned char>(bytes[i]));
  }
  return value;
}

/// Seconds and nanoseconds, four bytes each, as ns; nanoseconds of a whole second or more are refused.
std::uint64_t bag_time_ns(std::string_view bytes, const BagPlace& place, const std::string& field);

/// The fields of one header. Views into the bytes that it was made from.
class BagHeader {
 public:
  /// Throws BagError: a field is longer than the header, lacks its `=` or a name, or stands there twice; more than
  /// kMaxFields.
  BagHeader(std::string_view bytes, const BagPlace& place);

  /// Each throws BagError where the field is absent or of another size.
  BagOp op() const;
  std::uint32_t u32(std::string_view name) const;
  std::uint64_t u64(std::string_view name) const;
  std::uint64_t time_ns(std::string_view name) const;
  std::string_view text(std::string_view name) const;

  bool has(std::string_view name) const { return find(name) != nullptr; }
  const BagPlace& place() const { return place_; }

 private:
  struct Field {
    std::string_view name, value;
    std::uint64_t offset;  // of the value, in the header
  };
  static constexpr std::size_t kMaxFields = 32;

  const Field* find(std::string_view name) const;
  const Field& sized(std::string_view name, std::size_t size) const;

  BagPlace place_;
  std::array<Field, kMaxFields> fields_;
  std::size_t count_ = 0;
};

/// One record in memory.
struct BagRecord {
  BagHeader header;
  std::string_view data;
  BagPlace data_place;
  std::size_t size;  ///< bytes, of the whole record
};

/// The record at the begin of `bytes`. Throws BagError; `ends`: `bytes` ends within the record.
BagRecord read_bag_record(std::string_view bytes, const BagPlace& place);

}  // namespace robot_control
