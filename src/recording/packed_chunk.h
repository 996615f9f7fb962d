#pragma once
/// The records of a ROS bag, version 2.0 (wiki.ros.org/Bags/Format/2.0), and a chunk of messages, compressed with LZ4.
///
/// A record is a header of named fields and data, each behind its length in 4 bytes, little endian.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bags/bag_record.h"

namespace robot_control {

/// Appends values as a bag and a ROS message have them: little endian, texts and lists behind their length.
class ByteSink {
 public:
  explicit ByteSink(std::string& to) : to_(to) {}

  template <class Number>
  void number(Number value) {
    to_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    to_.append(value);
  }

  /// Seconds and nanoseconds, 4 bytes each.
  void time(std::int64_t ns) {
    number(static_cast<std::uint32_t>(ns / 1'000'000'000));
    number(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }

 private:
  std::string& to_;
};

/// The fields of a record's header.
class BagFields {
 public:
  explicit BagFields(BagOp kind) { number("op", static_cast<std::uint8_t>(kind)); }

  template <class Number>
  BagFields& number(std::string_view name, Number value) {
    begin(name, sizeof value).number(value);
    return *this;
  }
  BagFields& text(std::string_view name, std::string_view value) {
    begin(name, value.size());
    bytes_.append(value);
    return *this;
  }
  BagFields& time(std::string_view name, std::int64_t ns) {
    begin(name, 8).time(ns);
    return *this;
  }

  const std::string& bytes() const noexcept { return bytes_; }

 private:
  ByteSink begin(std::string_view name, std::size_t size) {
    ByteSink sink(bytes_);
    sink.number(static_cast<std::uint32_t>(name.size() + 1 + size));
    bytes_.append(name).push_back('=');
    return sink;
  }

  std::string bytes_;
};

void append_record(std::string& to, const BagFields& fields, std::string_view data);

inline constexpr std::size_t kEntryBytes = 12;  ///< of a chunk's index, for each message: time and offset

/// A chunk ready for the file: its record, and the index of its messages behind it.
struct PackedChunk {
  std::string record = {};
  std::string index = {};
  std::int64_t begin_ns = 0;                          ///< time of its earliest message
  std::int64_t end_ns = 0;                            ///< of its latest
  std::map<std::uint32_t, std::uint32_t> count = {};  ///< messages by connection
};

/// Collects messages for a chunk.
class ChunkBuilder {
 public:
  /// `connection`: number of a connection record, of this chunk or an earlier one. `time_ns`: ROS time, above 0.
  void add(std::uint32_t connection, std::int64_t time_ns, std::string_view message);

  /// A record that is no message: that of a connection.
  void add_record(std::string_view record) { content_.append(record); }

  bool empty() const noexcept { return content_.empty(); }
  std::size_t size() const noexcept { return content_.size(); }  ///< bytes, uncompressed
  std::int64_t begin_ns() const noexcept { return begin_ns_; }

  /// Compresses what was added; the next chunk begins empty.
  PackedChunk take();

 private:
  std::string content_;
  std::map<std::uint32_t, std::string> entries_;  ///< of the index: time and offset of each message, by connection
  std::int64_t begin_ns_ = 0;
  std::int64_t end_ns_ = 0;
};

}  // namespace robot_control
