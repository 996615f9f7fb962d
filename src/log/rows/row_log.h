#pragma once
/// A log receives row after row.

#include "log/rows/joined_row.h"
#include "signals/law_snapshot.h"

namespace robot_control {

class RowLog {
 public:
  virtual ~RowLog() = default;

  /// Throws LogError once if the disk refuses the row; the log ends then.
  virtual void write(const JoinedRow& row) = 0;

  /// Writes the state of a law before the next row.
  virtual void write(const LawSnapshot& snapshot) = 0;

  /// Completes the file. Throws LogError.
  virtual void close() = 0;
};

}  // namespace robot_control
