#pragma once
/// A reader gives rows that own the parts to which JoinedRow points.

#include <cstdint>

#include "log/rows/joined_row.h"

namespace robot_control {

/// Each node has a bit.
enum TracePart : std::uint8_t {
  kPartDriver = 1u << 0,
  kPartEstimator = 1u << 1,
  kPartController = 1u << 2,
  kPartMonitor = 1u << 3,
};

/// The members of the frames that are in the log (trace_fields.cpp) are as recorded; the others have their defaults.
/// Outputs that are recorded as float32 have that precision; frames that an injected fault changed are exact.
struct TraceRow {
  std::int64_t run = 0;      ///< JoinedRow::run
  std::uint64_t run_id = 0;  ///< FrameHead::run
  std::uint64_t cycle = 0;
  std::int64_t stamp_ns = 0;   ///< FrameHead::stamp_ns
  std::uint8_t parts = 0;      ///< TracePart bits of the nodes that have a row
  std::uint8_t published = 0;  ///< TracePart bits of the nodes whose frame was published
  bool repeats = false;        ///< JoinedRow::repeats
  std::uint64_t lost = 0;      ///< rows lost before this one, since its telemetry began (TraceSource::lost)
  DriverTrace driver;
  EstimatorTrace estimator;
  ControllerTrace controller;
  MonitorTrace monitor;

  /// The row as `Join` gives it; it is valid as long as this object. `period` is in s.
  JoinedRow joined(double period) const;
};

}  // namespace robot_control
