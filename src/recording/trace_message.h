#pragma once
/// A row ↔ the bytes of a message Trace.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "recording/fields/trace_fields.h"

namespace robot_control {

/// Replaces `to`.
void encode_trace(const TraceSource& source, std::string& to);

/// A log whose messages cannot be understood; the message names the field.
class TraceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads messages of the definition with which they were recorded, by an earlier or a later version of this package:
/// fields of another name or type are passed over, and what is missing keeps its default.
class TraceDecoder {
 public:
  /// Throws TraceError.
  explicit TraceDecoder(const std::string& definition);

  /// Replaces `row`. Throws TraceError: the message is too short or too long, or a list is longer than its member.
  void decode(std::string_view message, TraceRow& row) const;

  /// Are the fields those of this version, in their order?
  bool of_this_version() const;

  /// Fields of this version that the log does not have.
  const std::vector<std::string>& missing() const noexcept { return missing_; }

 private:
  struct Step {
    std::string name;
    const TraceField* field = nullptr;  ///< null: passed over
    std::size_t element = 0;            ///< bytes
    std::size_t count = 1;              ///< 0: a list, behind its length
  };

  std::vector<Step> steps_;
  std::vector<std::string> missing_;
};

}  // namespace robot_control
