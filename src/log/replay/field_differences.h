#pragma once
/// Compares rows, and their messages, by the names of their fields. Per field there is at most one difference: its
/// first element that differs, or its length.

#include <string>
#include <string_view>
#include <vector>

#include "log/fields/trace_fields.h"

namespace robot_control {

struct FieldDifference {
  std::string field;  ///< "nis[2]"
  std::string logged;
  std::string replayed;
};

/// Compares every member of two rows of the same nodes, with its full precision.
std::vector<FieldDifference> differences(const JoinedRow& logged, const JoinedRow& computed);

/// Compares `message` of a log byte by byte with the message of `expected`. `message` can be decoded.
std::vector<FieldDifference> differences(std::string_view message, const TraceSource& expected);

}  // namespace robot_control
