#pragma once
/// Replay of a closed loop while it runs: robot_control._robot_control.LoopReplay, for campaigns.

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "recording/trace_message.h"
#include "replay/replay.h"
#include "simulation/closed_loop.h"

namespace robot_control {

class LoopReplay {
 public:
  /// Before the first step of `loop`.
  explicit LoopReplay(const ClosedLoop& loop)
      : replay_(loop.parameters(), loop.robot()), joints_(loop.robot().joints.size()) {}

  /// After a step.
  void note(const ClosedLoop& loop);

  /// Runs the laws again over what was noted since the last call.
  void check();

  /// What was found, after the last row.
  pybind11::dict report();

 private:
  Replay replay_;
  std::size_t joints_;
  TraceDecoder decoder_{trace_definition()};
  std::vector<std::string> messages_;  ///< of the rows that were noted, as a log has them
};

void bind_loop_replay(pybind11::module_& module);

/// A report as Python has it: exact, laws {name: {compared, different, not_compared, missing}}, rows, different_rows,
/// damaged_snapshots, differences, gaps.
pybind11::dict described(const ReplayReport& report);

}  // namespace robot_control
