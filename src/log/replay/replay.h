#pragma once
/// Runs the laws of a log again, from its rows and snapshots alone, and compares every bit of what they give.
///
///   snapshot ─► state of a law
///   rows     ─► its inputs: sensors, requests, and which frames of the other laws it used, by checksum
///            ─► step ─► checksum of the output, compared with that in the row; the output is what the others used
///
/// The whole message of a row that was read from a log is compared, byte for byte. Its fields are put together again
/// from the outputs of the laws and the frames that they used. Values that no law computes are covered by the checksum
/// of the message (field_differences.h).
///
/// A law is not compared until its next snapshot while its state is unknown: before its first snapshot, after missing
/// rows, in another process. The same holds after it used a frame that is neither in the log nor computed again. If an
/// injected fault replaced a law's output, the log holds the published frame, which the other laws used.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "log/replay/field_differences.h"
#include "log/replay/replicas.h"
#include "log/replay/report.h"
#include "log/replay/variant.h"
#include "log/rows/joined_row.h"
#include "log/rows/trace_row.h"
#include "robots/robot.h"
#include "signals/frame_head.h"
#include "signals/injected_fault.h"
#include "signals/law_snapshot.h"

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

/// Compares the message of a row in a log with what the laws gave, field by field.
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

class Replay {
 public:
  /// `robot` is that of the log, composed with the log's parameters; `period` is in s. Throws as the laws do.
  Replay(const Robot& robot, double period);
  Replay(Replay&&) = delete;  // its parts refer to the report

  /// The laws with other parameters beside those of the log, before the first row; `watch` gets each cycle of each.
  void vary(const Robot& robot, std::function<void(const VariedRow&)> watch);

  /// In any order, before the row that it belongs to. Throws ReplayError: it is of another build.
  void add(const LawSnapshot& snapshot);

  /// In the order of the log, from memory: what the laws gave is compared by its checksum.
  void add(const JoinedRow& row);

  /// In the order of the log, with its message and the time under which that stands: every field is compared as well.
  void add(TraceRow row, std::string_view message, std::int64_t time_ns);

  const ReplayReport& report() const noexcept { return report_; }

 private:
  void run_laws(TraceRow& row);
  void run(const TraceRow& row, DriverTrace& driver);
  void run(const TraceRow& row, EstimatorTrace& trace);
  void run(const TraceRow& row, ControllerTrace& trace);
  void run(const TraceRow& row, MonitorTrace& trace);
  std::string gate_input(const DriverTrace& driver, GateInput& input) const;
  template <class Replica>
  StateBefore before(Replica& replica, const LawRow& row);
  template <class Replica, class Trace>
  bool known(const TraceRow& row, Replica& replica, Trace& trace, StateBefore state, const std::string& missing);
  template <class Replica, class Trace>
  void compare(const TraceRow& row, Replica& replica, Trace& trace, FaultKind fault);
  void differ(const TraceRow& row, LawName law, const std::vector<FieldDifference>& fields);

  ReplayReport report_;
  RowCheck row_check_;
  SnapshotStore snapshots_;
  GateReplica gate_;
  LawReplica<EstimatorLaw, &EstimatorTrace::state, StateFrame> estimator_;
  LawReplica<ControllerLaw, &ControllerTrace::command, CommandFrame> controller_;
  LawReplica<MonitorLaw, &MonitorTrace::permit, Permit> monitor_;
  std::unique_ptr<Variant> variant_;
  std::function<void(const VariedRow&)> watch_;
};

}  // namespace robot_control
