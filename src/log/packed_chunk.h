#pragma once
/// A ROS bag, version 2.0 (wiki.ros.org/Bags/Format/2.0), consists of records and of chunks, compressed with LZ4.
///
/// A record has a header of named fields, and data. Each stands behind its length in 4 bytes, little endian.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "log/bag/bag_record.h"

namespace robot_control {

/// Appends values in the format of bags and ROS messages: little endian, with the length before texts and lists.
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

  /// A time has 4 bytes of seconds and 4 of nanoseconds.
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

inline constexpr std::size_t kEntryBytes = 12;  ///< bytes of a message in a chunk's index: time and offset

/// A chunk has its record and, behind it, the index of its messages.
struct PackedChunk {
  std::string record = {};
  std::string index = {};
  std::int64_t begin_ns = 0;                          ///< time of its earliest message
  std::int64_t end_ns = 0;                            ///< time of its latest message
  std::map<std::uint32_t, std::uint32_t> count = {};  ///< messages by connection
};

/// A thorough compression needs ten times as long for two thirds of the bytes.
enum class Effort { kFast = 0, kThorough = 3 };  // LZ4 has levels 0 … 12; the thorough ones begin at 3

/// Collects messages for a chunk.
class ChunkBuilder {
 public:
  /// `connection` is the number of a connection record in this chunk or an earlier one. `time_ns` is ROS time above 0.
  void add(std::uint32_t connection, std::int64_t time_ns, std::string_view message);

  /// Adds the record of a connection.
  void add_record(std::string_view record) { content_.append(record); }

  bool empty() const noexcept { return content_.empty(); }
  std::size_t size() const noexcept { return content_.size(); }  ///< uncompressed bytes
  std::int64_t begin_ns() const noexcept { return begin_ns_; }

  /// Compresses the collected messages and empties the builder.
  PackedChunk pack(Effort effort);

 private:
  std::string content_;
  std::map<std::uint32_t, std::string> entries_;  ///< the index by connection: time and offset of each message
  std::int64_t begin_ns_ = 0;
  std::int64_t end_ns_ = 0;
};

}  // namespace robot_control
