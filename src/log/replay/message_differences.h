#pragma once
/// Compares a message Trace of a log with the message that its row makes.

#include <string_view>
#include <vector>

#include "log/fields/trace_fields.h"
#include "log/replay/frame_fields.h"

namespace robot_control {

/// Compares `message` byte by byte with the message of `expected`. Per field of Trace at most one difference: its first
/// element that differs, or its length. `message` can be decoded.
std::vector<FieldDifference> differences(std::string_view message, const TraceSource& expected);

}  // namespace robot_control
