#pragma once
/// Every field of the message Trace, once: name, type, unit, and the member of a row that it holds.
///
/// From this table come the writer, the reader and msg/Trace.msg (tests/docs/trace_message.py writes it). A new member
/// of a row is one line here. What a law takes in is recorded bit for bit (float64, integers); what it puts out, which
/// a replay computes again, as float32. The last field is the checksum of all before it.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recording/trace_row.h"

namespace robot_control {

/// Takes values out of a message; beyond its end `ok` is false and every value 0.
class ByteSource {
 public:
  explicit ByteSource(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  Number number() {
    Number value{};
    if (bytes_.size() < sizeof value) {
      ok_ = false;
      return value;
    }
    bytes_.copy(reinterpret_cast<char*>(&value), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  std::string_view text() { return bytes(number<std::uint32_t>()); }
  std::string_view bytes(std::size_t size) {
    ok_ = ok_ && size <= bytes_.size();
    const std::string_view value = bytes_.substr(0, ok_ ? size : 0);
    bytes_.remove_prefix(value.size());
    return value;
  }

  bool ok() const noexcept { return ok_; }
  std::size_t left() const noexcept { return bytes_.size(); }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

/// What a message is made of.
struct TraceSource {
  const JoinedRow& row;
  std::uint64_t lost = 0;    ///< rows dropped or overwritten in the rings, or not taken by the disk, until now
  std::size_t joints = 0;    ///< of the robot: how long the lists of joints are
  std::int64_t time_ns = 0;  ///< under which the message stands in the bag
};

struct TraceField {
  std::string name;
  std::string type;          ///< of ROS: "float64", "float32[3]", "float64[]"
  std::string comment;       ///< unit and meaning
  std::string heading = {};  ///< in the .msg, before this field; mostly empty

  void (*put)(const TraceSource& source, std::string& to) = nullptr;
  /// False: the list is longer than the member.
  bool (*take)(ByteSource& from, TraceRow& row) = nullptr;
};

using TraceFields = std::vector<TraceField>;
const TraceFields& trace_fields();

/// The text of msg/Trace.msg.
std::string trace_definition();

}  // namespace robot_control
