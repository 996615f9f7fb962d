#pragma once
/// Compares the message of a row in a log with what the laws gave, field by field.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "log/replay/report.h"
#include "log/rows/trace_row.h"
#include "signals/frame_head.h"
#include "signals/injected_fault.h"

namespace robot_control {

/// Sets `logged` to the frame that the row has to hold: the computed one, or the one that `fault` made of it, sealed. A
/// fault breaks the seal of some frames (simulation/faults/node_faults.h). The content of a frame that it withheld is
/// not known.
template <class Frame>
void expect(const Frame& computed, FaultKind fault, Frame& logged) noexcept {
  const bool published = logged.head.kind == FrameKind::kFrame;
  if (fault == FaultKind::kOk || (published && logged.head.checksum == computed.head.checksum)) {
    logged = computed;
  } else if (published && logged.head.checksum != ~checksum_of(logged)) {
    seal(logged);
  }
}

class RowCheck {
 public:
  /// `joints` of the robot. `report` lives longer.
  RowCheck(std::size_t joints, ReplayReport& report) noexcept : joints_(joints), report_(report) {}

  /// Called in the order of the log. `row` holds the computed outputs in place of the logged ones. `message` is its
  /// message, and `time_ns` the time of that.
  void check(TraceRow& row, std::string_view message, std::int64_t time_ns);

 private:
  void place(TraceRow& row) noexcept;

  std::size_t joints_;
  ReplayReport& report_;
  std::int64_t run_ = -1;  ///< of the last row that repeats none; -1: there is none
  std::uint64_t run_id_ = 0;
  std::uint64_t cycle_ = 0;
};

}  // namespace robot_control
