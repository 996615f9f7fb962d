#pragma once
/// Runs the laws of a log again, from its rows and snapshots alone, and compares every bit of what they give.
///
///   snapshot ─► state of a law
///   rows     ─► its inputs: sensors, requests, and which frames of the other laws it used, by checksum
///            ─► step ─► checksum of the output, compared with that in the row; the output is what the others used
///
/// The whole message of a row that was read from a log is compared, byte for byte. Its fields are put together again
/// from the outputs of the laws and the frames that they used. Values that no law computes are covered by the checksum
/// of the message (message_differences.h).
///
/// A law is not compared until its next snapshot while its state is unknown: before its first snapshot, after missing
/// rows, in another process. The same holds after it used a frame that is neither in the log nor computed again. If an
/// injected fault replaced a law's output, the log holds the published frame, which the other laws used.

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "log/replay/report.h"
#include "log/replay/variant.h"
#include "log/rows/joined_row.h"
#include "log/rows/trace_row.h"
#include "robots/robot.h"
#include "signals/law_snapshot.h"

namespace robot_control {

class Replay {
 public:
  /// `robot` is that of the log, composed with the log's parameters; `period` is in s. Throws as the laws do.
  Replay(const Robot& robot, double period);
  ~Replay();

  /// The laws with other parameters beside those of the log, before the first row; `watch` gets each cycle of each.
  void vary(const Robot& robot, std::function<void(const VariedRow&)> watch);

  /// In any order, before the row that it belongs to. Throws ReplayError: it is of another build.
  void add(const LawSnapshot& snapshot);

  /// In the order of the log, from memory: what the laws gave is compared by its checksum.
  void add(const JoinedRow& row);

  /// In the order of the log, with its message and the time under which that stands: every field is compared as well.
  void add(const TraceRow& row, std::string_view message, std::int64_t time_ns);

  const ReplayReport& report() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace robot_control
