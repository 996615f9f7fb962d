#pragma once
/// A log that takes row after row: run.csv, run.bag.

#include "signals/law_snapshot.h"
#include "telemetry/joined_row.h"

namespace robot_control {

class RowLog {
 public:
  virtual ~RowLog() = default;

  /// Throws LogError once, when the disk takes no more; the log ends then.
  virtual void write(const JoinedRow& row) = 0;

  /// The state of a law before the next row; a log of rows alone leaves it out.
  virtual void write(const LawSnapshot& /*snapshot*/) {}

  /// Completes the file. Throws LogError.
  virtual void close() = 0;
};

}  // namespace robot_control
