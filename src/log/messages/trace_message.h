#pragma once
/// These functions convert a row to the bytes of a message Trace and back.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "log/fields/trace_fields.h"

namespace robot_control {

/// Replaces `to`.
void encode_trace(const TraceSource& source, std::string& to);

/// The messages of a log cannot be understood; the text names the field.
class TraceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A bag that is no log at all: it does not begin with a TraceHeader.
class NoTraceError : public TraceError {
 public:
  using TraceError::TraceError;
};

/// Reads messages by the definition with which another version of this package recorded them. Fields of another name or
/// type are passed over, and missing fields keep their default.
class TraceDecoder {
 public:
  /// Throws TraceError.
  explicit TraceDecoder(const std::string& definition);

  /// Replaces `row`. Throws TraceError: the message is too short or too long, or a list is longer than its member.
  void decode(std::string_view message, TraceRow& row) const;

  /// True: the fields are those of this version, in their order.
  bool of_this_version() const;

  /// The log lacks these fields of this version.
  const std::vector<std::string>& missing() const noexcept { return missing_; }

 private:
  struct Step {
    std::string name;
    const TraceField* field = nullptr;  ///< null: passed over
    std::size_t element = 0;            ///< bytes of one element
    std::size_t count = 1;              ///< 0: a list, behind its length
  };

  std::vector<Step> steps_;
  std::vector<std::string> missing_;
};

}  // namespace robot_control
